// SPDX-License-Identifier: MIT
#include "bench/pairs/bounds_in_use.h"

#include <algorithm>

#include "bench/case.h"
#include "bench/pairs/following.h"

namespace shaken::bench {

BoundsByKind measure_bounds(Simulation& simulation, Tick ticks) {
  constexpr double kWithin = 0.4;  // [mm]; as far as the neighbour list's skin
  const std::vector<PairRods> pairs = near_pairs(simulation, kWithin);
  const double dt = simulation.world().system.dt;
  const double hulls_ahead = static_cast<double>(TimingWheel::horizon()) * dt;
  const double beads_ahead = static_cast<double>(kBeadHorizon) * dt;
  BoundsByKind bounds;
  Following following(simulation, pairs);
  following.look();
  for (Tick k = 0; k < ticks; ++k) {
    advance(simulation, 1);
    for (const Following::Bounded& bounded : following.look()) {
      if (bounded.event == Following::Event::kTightened) continue;
      const auto& [i, j] = pairs[bounded.pair];
      const double time = time_to_contact(simulation.world(), i, j, bounded.by_beads ? beads_ahead : hulls_ahead);
      if (!(time > 0)) continue;  // they touch already
      BoundsInUse& of_kind = bounded.by_beads ? bounds.beads : bounds.hulls;
      of_kind.of_true_time.push_back(std::min(1.0, bounded.safe / time));
      of_kind.of_no_tick += bounded.safe < 1.5 * dt ? 1 : 0;
    }
  }
  return bounds;
}

}  // namespace shaken::bench
