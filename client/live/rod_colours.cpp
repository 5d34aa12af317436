// SPDX-License-Identifier: MIT
#include "client/live/rod_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace shaken::client {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kLayerSteps = 4;   // on either side
constexpr int kWheelSteps = 24;  // of half a turn
constexpr int kTiltSteps = 5;
constexpr double kFullAngle = 15 * kPi / 180;
constexpr double kFullTilt = 0.5;

// Equal steps in OKLab (Ottosson 2020) from one end to the other.
constexpr std::array<Ink, 2 + 2 * kLayerSteps + 1 + kWheelSteps + kTiltSteps + 3> kInks{
    0x16181C, 0x7A7F8A,                                // floor, wall
    0x2F8FFF, 0x67A8FB, 0x95BEF5, 0xC1D4EE, 0xECE8E4,  // right of the director to along it
    0xF3D4BA, 0xF9BE8E, 0xFDA85E, 0xFF9000,            // and on to the left of it
    0xF08B7C, 0xEC8F67, 0xE59654, 0xDA9E45, 0xCBA640, 0xB8AE45, 0xA2B654, 0x89BC68,  // the wheel from 0 degrees
    0x6EC17E, 0x4FC495, 0x2DC4AC, 0x05C3C2, 0x0FC0D5, 0x34BBE5, 0x54B5F1, 0x71AEF9,  //
    0x8AA7FB, 0xA19FF7, 0xB698EF, 0xC892E2, 0xD68DD2, 0xE289BE, 0xEA88A9, 0xEF8893,  //
    0x2A5F9E, 0x5F839F, 0x93A49C, 0xC8C592, 0xFFE680,                                // flat to steep
    0xECE8E4, 0x6FA3A8, 0x9A7FB8,                                                    // first, second, third species
};
static_assert(std::ssize(kInks) == kToneCount);
constexpr int kLayerMiddle = 2 + kLayerSteps;
constexpr int kWheelBegin = kLayerMiddle + kLayerSteps + 1;
constexpr int kTiltBegin = kWheelBegin + kWheelSteps;
constexpr int kSpeciesBegin = kTiltBegin + kTiltSteps;

}  // namespace

const char* name_of(Colouring colouring) {
  static constexpr std::array kNames{"auto", "angle to the director", "angle", "tilt", "species"};
  return kNames[static_cast<std::size_t>(colouring)];
}

Tone layer_tone(double theta) {
  const double part = std::clamp(theta / kFullAngle, -1.0, 1.0);
  return static_cast<Tone>(kLayerMiddle + std::lround(part * kLayerSteps));
}

Tone wheel_tone(double angle) {
  const long step = std::lround(angle * kWheelSteps / kPi) % kWheelSteps;
  return static_cast<Tone>(kWheelBegin + (step + kWheelSteps) % kWheelSteps);
}

Tone tilt_tone(double n_z) {
  const double part = std::min(std::abs(n_z) / kFullTilt, 1.0);
  return static_cast<Tone>(kTiltBegin + std::lround(part * (kTiltSteps - 1)));
}

Tone species_tone(std::size_t species) { return static_cast<Tone>(kSpeciesBegin + std::min<std::size_t>(species, 2)); }

Ink ink_of(Tone tone) { return kInks[tone]; }

Ink ink_of(Tone tone, double share) {
  Ink mixed = 0;
  for (const int shift : {16, 8, 0}) {
    const double floor = kInks[kFloorTone] >> shift & 0xFF, top = kInks[tone] >> shift & 0xFF;
    mixed |= static_cast<Ink>(std::lround(floor + share * (top - floor))) << shift;
  }
  return mixed;
}

Colouring automatic_colouring(double order, Colouring last) {
  if (std::isnan(order)) return Colouring::kSpecies;
  if (order > 0.6) return Colouring::kLayers;
  if (order < 0.4) return Colouring::kWheel;
  return last;
}

}  // namespace shaken::client
