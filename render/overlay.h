// SPDX-License-Identifier: MIT
#pragma once

#include "render/canvas.h"
#include "render/layout.h"
#include "render/picture.h"

namespace shaken::render {

/// Draws everything except the rods: frame, defects, caption, S(t), legend and scale bar.
void draw_overlay(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// The longest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length(double length);

}  // namespace shaken::render
