// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "render/style.h"

namespace shaken::render {

/// sRGB, each component in [0, 1].
using Colour = std::array<double, 3>;

/// Colour of a rod at `theta` to the director, in [-pi/2, pi/2) [rad]: red if it leans to the left (theta > 0), magenta
/// if to the right, as in Sharma & Soni (2024), growing out of a neutral tone over the first 15 degrees so that layers
/// stand out; from 45 degrees on it fades into grey, so that +90 and -90 degrees, which are the same, look the same.
Colour layer_colour(double theta);

/// Colour of an axis at `angle` [rad]: a circle of period pi in OKLab (Ottosson 2020), so equal turns look equally
/// large. The circle is tilted: what is redder is darker, so those who do not tell red from green tell angles by their
/// lightness.
Colour wheel_colour(double angle);

/// The same circle for directions, which have the period 2 pi [rad].
Colour heading_colour(double direction);

/// From dark blue over green to yellow, lighter all the way: viridis (van der Walt & Smith 2015), for x in [0, 1].
Colour sequential_colour(double x);

/// From blue (-1) over a neutral tone (0) to orange (1), the two ends equally far from the middle in lightness.
Colour diverging_colour(double x);

/// Colour of all rods of another species than the first, 1 or 2, beside rods coloured by angle: duller than those, and
/// apart in lightness.
Colour species_colour(std::size_t species);

/// Colours of 0, 1, 2, ... things to be told apart: Okabe and Ito's first, which the colour-blind tell apart too.
Colour name_colour(std::size_t index);

/// A colour of its own for each of many rods.
Colour number_colour(std::size_t number);

/// Of what has no value.
Colour no_value_colour();

/// The local order S under the director field: that of the floor where S = 1, dark where S = 0.
Colour order_background(double order, Theme theme);

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
