// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "render/canvas.h"
#include "render/picture.h"
#include "render/picture_layout.h"
#include "render/style.h"

namespace shaken::render {

/// Draws everything except ground and rods: director field, frame, defects, caption, S(t), legend and scale bar.
void draw_overlay(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// Of a film: how far it is, as a bar along the picture's lower edge.
void draw_time_bar(const Canvas& canvas, const RodPicture& picture, const PictureStyle& style);

/// How fast a film plays, "1/10 speed", "6× speed", from simulated seconds per second; nothing if it is not known.
std::string playback_text(double playback);

/// The longest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length(double length);

}  // namespace shaken::render
