#pragma once

#include <array>
#include <cstddef>

namespace shaken {

/// sRGB, each component in [0, 1].
using Colour = std::array<double, 3>;

/// The colours of rods, one table for pictures, films, the page and the terminal. Only the two sides of the director
/// differ between palettes.
enum class Palette {
  kSafe,   ///< orange and blue, which people who confuse red and green tell apart
  kPaper,  ///< red and magenta, as in Sharma & Soni (2024)
};

/// Nematic order S from which automatic colours are those of layers, not those of angles in the box: in pictures, on
/// the page and in the terminal. What follows a run stays with its colours until S is beyond this by the margin, so
/// that they do not flicker.
inline constexpr double kOrderOfLayers = 0.7, kOrderMargin = 0.1;

/// Colour of a rod at `theta` to the director, in [-pi/2, pi/2] [rad]: orange (red) if it leans to the left
/// (theta > 0), blue (magenta) if to the right, growing out of a neutral tone over the first 15 degrees so that layers
/// stand out; from 45 degrees on it fades into grey, so that +90 and -90 degrees, which are the same, look the same.
Colour layer_colour(double theta, Palette palette = Palette::kSafe);

/// Colour of an axis at `angle` [rad]: a circle of period pi in OKLab (Ottosson 2020), so equal turns look equally
/// large. The circle is tilted: what is redder is darker, so those who do not tell red from green tell angles by their
/// lightness.
Colour wheel_colour(double angle);

/// The same circle for directions, which have the period 2 pi [rad].
Colour heading_colour(double direction);

/// From dark blue over green to yellow, lighter all the way: viridis (van der Walt & Smith 2015), for x in [0, 1].
Colour sequential_colour(double x);

/// From blue (-1) over the neutral tone (0) to orange (1).
Colour diverging_colour(double x);
/// The tilt n_z at which this scale ends, on either side.
inline constexpr double kFullTilt = 0.3;

/// Colour of all rods of another species than the first, 1 or 2, beside rods coloured by angle: dark and nearly grey,
/// which no angle is.
Colour species_colour(std::size_t species);

/// Colours of 0, 1, 2, ... things to be told apart: Okabe and Ito's first, which the colour-blind tell apart too.
Colour name_colour(std::size_t index);

/// A colour of its own for each of many rods.
Colour number_colour(std::size_t number);

/// The colour of what has no value.
Colour no_value_colour();

/// The colour of a field where there is no order: blue-grey, lighter over a light page.
Colour no_order_colour(bool is_page_dark);

/// From one colour (t = 0) to another (1), by their sRGB components.
Colour blend(const Colour& x, const Colour& y, double t);

}  // namespace shaken
