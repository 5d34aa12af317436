// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sim/world.h"

namespace shaken::bench {

/// Times that no stepper of this model can go below, measured on the rods of one state [s].
struct LowerBounds {
  double plate_impulse = 0;  ///< of one impulse from a plate: pose, motion, impulse and the new flight
  double rod_impulse = 0;    ///< of one impulse between two rods: the same for both
  double state_access = 0;   ///< of reading and writing one rod's state at a random place, computing nothing
};

/// Runs the real kernels (sim/motion, sim/contact) on the rods of `world`. A plate impulse hits the end that comes
/// first; an impulse between rods hits the closest beads of two rods that approach each other, wherever they are.
LowerBounds measure_lower_bounds(const World& world);

/// Impulses alone: what is left if finding contacts costs nothing [s].
double impulses_alone(const LowerBounds& bounds, std::int64_t plate_impulses, std::int64_t rod_impulses);

/// Memory alone: every impulse reads and writes the state of the rods that it changes, one or two [s].
double memory_alone(const LowerBounds& bounds, std::int64_t plate_impulses, std::int64_t rod_impulses);

}  // namespace shaken::bench
