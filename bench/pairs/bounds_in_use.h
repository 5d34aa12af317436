// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "sim/simulation.h"

namespace shaken::bench {

/// New bounds of pairs that do not touch, as they were asked for in a run.
struct BoundsInUse {
  std::vector<double> of_true_time;  ///< each over the time to contact in free flight, as far as bounds look ahead
  std::size_t of_no_tick = 0;        ///< of these, too short to save the visit at the next tick
};
struct BoundsByKind {
  BoundsInUse hulls;
  BoundsInUse beads;  ///< those for which beads were looked at
};

/// Steps on by `ticks` and follows the pairs of rods that are near each other before.
BoundsByKind measure_bounds(Simulation& simulation, Tick ticks);

}  // namespace shaken::bench
