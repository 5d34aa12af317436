// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sim/world.h"

namespace shaken::bench {

enum class Norm { kPosition, kDirector, kEnergy };
inline constexpr int kNorms = 3;
inline constexpr std::array<const char*, kNorms> kNormNames{"position", "director", "energy"};
inline constexpr std::array<const char*, kNorms> kNormUnits{"mm", "rad", "1"};

/// How far two states of the same rods at the same time are apart, by Norm: root mean square over the rods of the
/// distance of their unwrapped centres [mm] and of the angle between their directors [rad]; difference of the kinetic
/// energies over that of `truth`.
using Errors = std::array<double, kNorms>;
Errors errors_between(const World& state, const World& truth);

}  // namespace shaken::bench
