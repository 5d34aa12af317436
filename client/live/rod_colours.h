#pragma once

#include <cstddef>
#include <cstdint>

#include "base/palettes.h"

namespace shaken::client {

/// A colour of a cell: 0xRRGGBB, the terminal's own, or one of the eight that the terminal's theme defines.
using Ink = std::int32_t;
inline constexpr Ink kOwnInk = -1;
/// The ink of the theme, 0 to 7: black, red, green, yellow, blue, magenta, cyan, white.
constexpr Ink theme_ink(int number) { return -2 - number; }

/// By what rods are coloured.
enum class Colouring {
  kAuto,     ///< kLayers where there is order, kWheel where there is none
  kLayers,   ///< the angle to the director: orange to the left, blue to the right, pale along it
  kWheel,    ///< the angle in the box, on a circle of period 180 degrees
  kTilt,     ///< which end is raised: n_z, orange if it is the head, blue if the tail
  kSpecies,  ///< one colour for each species
};
const char* name_of(Colouring colouring);

/// One of the few dozen colours that are used in a picture. Few, so that a cell often keeps its colour from one picture
/// to the next and need not be sent again.
using Tone = std::uint8_t;
inline constexpr Tone kFloorTone = 0;  ///< the floor
inline constexpr Tone kWallTone = 1;
inline constexpr int kToneCount = 55;

// The colours are those of base/palettes.h, as in the pictures of shaken-render.

/// `theta` in [-pi/2, pi/2] [rad].
Tone layer_tone(double theta);
/// 24 for half a turn.
Tone wheel_tone(double angle);
Tone tilt_tone(double n_z);
/// The tone of rods that are coloured by species.
Tone species_tone(std::size_t species);
/// The tone of all rods of another species than the first, where those have colours of angles.
Tone other_tone(std::size_t species);

Ink ink_of(const shaken::Colour& colour);

Ink ink_of(Tone tone);
/// `share` of `tone` over the floor, 0 to 1.
Ink ink_of(Tone tone, double share);

/// What kAuto stands for at nematic order S: kLayers above kOrderOfLayers (base/palettes.h), kWheel below it, and
/// `last` within its margin. kSpecies where there is no S (NaN): spheres have no axis.
Colouring automatic_colouring(double order, Colouring last);

}  // namespace shaken::client
