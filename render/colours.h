// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "render/picture.h"

namespace shaken::render {

/// sRGB, each component in [0, 1].
using Colour = std::array<double, 3>;

/// Colour of a rod at `theta` to the director [rad]: red if it leans to the left (theta > 0), magenta if to the right,
/// as in Sharma & Soni (2024), growing out of a neutral tone over the first 15 degrees so that layers stand out.
Colour layer_colour(double theta);

/// Colour of a rod at `angle` in the box [rad]: a circle of period pi at one lightness and chroma in OKLab
/// (Ottosson 2020), so equal turns look equally large.
Colour wheel_colour(double angle);

/// Colour of all rods of another species than the first, 1 or 2: duller than those of angles, and apart in lightness.
Colour species_colour(std::size_t species);

/// The colour that rod `i` of the picture has.
Colour rod_colour(const RodPicture& picture, std::size_t i, Colouring colouring);

/// The colours around the rods.
struct Palette {
  Colour page;   ///< outside the box
  Colour floor;  ///< the base plate
  Colour ink;    ///< text and lines
  Colour faint;  ///< secondary text and lines
  Colour walls;  ///< what lies beyond the side walls
};
Palette palette(Theme theme);

}  // namespace shaken::render
