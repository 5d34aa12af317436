// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "client/live/ink.h"

namespace shaken::client {

/// By what rods are coloured.
enum class Colouring {
  kAuto,     ///< kLayers where there is order, kWheel where there is none
  kLayers,   ///< the angle to the director: orange to the left, blue to the right, pale along it
  kWheel,    ///< the angle in the box, on a circle of period 180 degrees
  kTilt,     ///< how steeply they stand: |n_z|
  kSpecies,  ///< one colour for each species
};
const char* name_of(Colouring colouring);

/// One of the few dozen colours that are used in a picture. Few, so that a cell often keeps its colour from one picture
/// to the next and need not be sent again.
using Tone = std::uint8_t;
inline constexpr Tone kFloorTone = 0;  ///< the floor
inline constexpr Tone kWallTone = 1;
inline constexpr int kToneCount = 43;

/// The colours change from pale over the first 15 degrees (`theta` in [-pi/2, pi/2], in radians). Orange and blue are
/// told apart by people who confuse red and green.
Tone layer_tone(double theta);
/// 24 colours of one lightness and chroma for half a turn (OKLab, Ottosson 2020), as in the pictures of shaken-render.
Tone wheel_tone(double angle);
/// From blue (flat) to yellow (|n_z| = 0.5 and more).
Tone tilt_tone(double n_z);
Tone species_tone(std::size_t species);

Ink ink_of(Tone tone);
/// `share` of `tone` over the floor, 0 to 1.
Ink ink_of(Tone tone, double share);

/// What kAuto stands for at nematic order S: kLayers above 0.6, kWheel below 0.4, and `last` between, so that it does
/// not flicker. kSpecies where there is no S (NaN): spheres have no axis.
Colouring automatic_colouring(double order, Colouring last);

}  // namespace shaken::client
