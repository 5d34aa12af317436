#pragma once

#include <string>

#include "render/canvas.h"
#include "render/colourings.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// Whether the colours of a picture are a scale, rather than names.
bool has_scale(const RodPicture& picture, const PictureStyle& style);

/// The largest share of the rods that one bar of the legend has; 0 if it has none.
double highest_bar(const RodPicture& picture, const PictureStyle& style);

/// What a scale is called, with its unit if that does not stand at its ticks: "Velocity along the axis (mm/s)".
std::string title_of(const Colouring& colouring);

/// A scale's colours, continuous, with ticks below them. `is_below`, `is_above`: whether its ends stand for values
/// beyond it, too.
void draw_colour_bar(const Canvas& canvas, const Rect& bar, double unit, const Colouring& colouring, const Vec2& range,
                     const PictureStyle& style, bool is_below = false, bool is_above = false);

/// What the colours mean, and how many rods have each. A scale from low to high gets a histogram over an axis in the
/// colouring's unit, the share of rods in percent upwards, and the colours below the axis; a circle gets a rose of
/// angles within the colours, half a circle for axes, which have no head. Rods that the colouring has no value for are
/// not counted. Of a picture without rods it is the
/// background that is explained.
void draw_legend(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                 const PictureStyle& style);

}  // namespace shaken::render
