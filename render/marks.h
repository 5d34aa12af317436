#pragma once

#include "render/canvas.h"

namespace shaken::render {

/// How far from its core anything of a mark reaches, in units.
inline constexpr double kMarkReach = 36;

/// A defect of charge +1/2 at pixel (x, y): a comet, its head at the core and its tail along `direction` [rad,
/// counter-clockwise], the ray along which the director is radial; a white line in the tail is the axis.
void draw_plus_half(const Canvas& canvas, double x, double y, double direction, double unit);

/// A defect of charge -1/2: three arms along `direction` and the two directions at 120 degrees to it.
void draw_minus_half(const Canvas& canvas, double x, double y, double direction, double unit);

}  // namespace shaken::render
