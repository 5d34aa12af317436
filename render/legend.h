// SPDX-License-Identifier: MIT
#pragma once

#include "render/canvas.h"
#include "render/picture.h"

namespace shaken::render {

/// What the colours mean, and how many rods have each: a histogram of the angle to the director above a colour bar
/// (kLayers), or a rose of angles in the box inside a half wheel (kWheel; an undirected line turns back into itself
/// after half a turn).
void draw_legend(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                 const PictureStyle& style);

}  // namespace shaken::render
