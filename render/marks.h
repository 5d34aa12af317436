// SPDX-License-Identifier: MIT
#pragma once

#include "render/canvas.h"

namespace shaken::render {

/// A defect of charge +1/2 at pixel (x, y): a filled disc with an arrow along `direction` [rad, counter-clockwise].
void draw_plus_half(const Canvas& canvas, double x, double y, double direction, double unit);

/// A defect of charge -1/2: three arms along `direction` and the two directions at 120 degrees to it.
void draw_minus_half(const Canvas& canvas, double x, double y, double direction, double unit);

}  // namespace shaken::render
