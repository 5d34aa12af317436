#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/picture.h"
#include "render/picture_layout.h"
#include "render/style.h"

namespace shaken::render {

/// Draws everything except ground and rods: director field, frame, defects, caption, S(t), legend and scale bar.
void draw_overlay(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// A number of the caption, and its name.
struct Number {
  std::string name, value;
};
/// The numbers of the caption; rods are counted in view and in all where those differ.
std::vector<Number> numbers_of(const RodPicture& picture, const PictureStyle& style);
/// How many defects of the sign of `charge` there are, and how many of them are in view.
std::string defects_text(const RodPicture& picture, const PictureStyle& style, double charge);
/// How many rods of one species there are, and their S.
std::string species_text(const Cell& cell, const Frame& frame, std::size_t species);

/// Draws how far a film is, as a bar along the picture's lower edge.
void draw_time_bar(const Canvas& canvas, const Captions& captions, const PictureStyle& style);

/// How fast a film plays, "1/10 speed", "6× speed", from simulated seconds per second; nothing if it is not known.
std::string playback_text(double playback);

}  // namespace shaken::render
