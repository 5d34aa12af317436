#include "client/live/rod_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numbers>

namespace shaken::client {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLayerDegrees[] = {0, 3.75, 7.5, 11.25, 15, 60, 75, 90};  // on either side: it grows, stays, fades
constexpr int kLayerSteps = static_cast<int>(std::size(kLayerDegrees)) - 1;
constexpr int kWheelSteps = 24;  // of half a turn
constexpr int kTiltSteps = 4;    // on either side
constexpr int kLayerMiddle = 2 + kLayerSteps;
constexpr int kWheelBegin = kLayerMiddle + kLayerSteps + 1;
constexpr int kTiltMiddle = kWheelBegin + kWheelSteps + kTiltSteps;
constexpr int kSpeciesBegin = kTiltMiddle + kTiltSteps + 1;
constexpr int kOtherBegin = kSpeciesBegin + 3;
static_assert(kOtherBegin + 2 == kToneCount);

std::array<Ink, kToneCount> inks() {
  std::array<Ink, kToneCount> all{0x16181C, 0x7A7F8A};  // floor, wall
  const auto set = [&](int tone, const shaken::Colour& colour) {
    all[static_cast<std::size_t>(tone)] = ink_of(colour);
  };
  for (int i = -kLayerSteps; i <= kLayerSteps; ++i) {
    set(kLayerMiddle + i, layer_colour((i < 0 ? -1 : 1) * kLayerDegrees[std::abs(i)] * kPi / 180));
  }
  for (int i = 0; i < kWheelSteps; ++i) set(kWheelBegin + i, wheel_colour(i * kPi / kWheelSteps));
  for (int i = -kTiltSteps; i <= kTiltSteps; ++i) set(kTiltMiddle + i, diverging_colour(double(i) / kTiltSteps));
  for (int i = 0; i < 3; ++i) set(kSpeciesBegin + i, name_colour(static_cast<std::size_t>(i)));
  for (int i = 0; i < 2; ++i) set(kOtherBegin + i, species_colour(static_cast<std::size_t>(i + 1)));
  return all;
}

}  // namespace

const char* name_of(Colouring colouring) {
  static constexpr std::array kNames{"auto", "angle to the director", "angle in the box", "tilt", "species"};
  return kNames[static_cast<std::size_t>(colouring)];
}

Tone layer_tone(double theta) {
  const double degrees = std::abs(theta) * 180 / kPi;
  long step = 0;
  while (step < kLayerSteps && degrees > (kLayerDegrees[step] + kLayerDegrees[step + 1]) / 2) ++step;
  return static_cast<Tone>(kLayerMiddle + (theta < 0 ? -step : step));
}

Tone wheel_tone(double angle) {
  const long step = std::lround(angle * kWheelSteps / kPi) % kWheelSteps;
  return static_cast<Tone>(kWheelBegin + (step + kWheelSteps) % kWheelSteps);
}

Tone tilt_tone(double n_z) {
  return static_cast<Tone>(kTiltMiddle + std::lround(std::clamp(n_z / kFullTilt, -1.0, 1.0) * kTiltSteps));
}

Tone species_tone(std::size_t species) { return static_cast<Tone>(kSpeciesBegin + std::min<std::size_t>(species, 2)); }

Tone other_tone(std::size_t species) {
  return static_cast<Tone>(kOtherBegin + std::clamp<std::size_t>(species, 1, 2) - 1);
}

Ink ink_of(const shaken::Colour& colour) {
  Ink ink = 0;
  for (const double part : colour) ink = ink << 8 | static_cast<Ink>(std::lround(255 * part));
  return ink;
}

Ink ink_of(Tone tone) {
  static const std::array<Ink, kToneCount> kInks = inks();
  return kInks[tone];
}

Ink ink_of(Tone tone, double share) {
  Ink mixed = 0;
  for (const int shift : {16, 8, 0}) {
    const double floor = ink_of(kFloorTone) >> shift & 0xFF, top = ink_of(tone) >> shift & 0xFF;
    mixed |= static_cast<Ink>(std::lround(floor + share * (top - floor))) << shift;
  }
  return mixed;
}

Colouring automatic_colouring(double order, Colouring last) {
  if (std::isnan(order)) return Colouring::kSpecies;
  if (order > kOrderOfLayers + kOrderMargin) return Colouring::kLayers;
  if (order < kOrderOfLayers - kOrderMargin) return Colouring::kWheel;
  return last;
}

}  // namespace shaken::client
