// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sim/simulation.h"

/// Whether two ways of stepping the same scene give the same, to the last bit: states, counters and ledgers.
namespace shaken::test {

inline bool same(const Counters& a, const Counters& b) {
  const auto all = [](const Counters& c) {
    std::vector<double> values{static_cast<double>(c.impulses_rod_rod),
                               static_cast<double>(c.impulses_rod_base),
                               static_cast<double>(c.impulses_rod_lid),
                               static_cast<double>(c.impulses_rod_wall),
                               static_cast<double>(c.noise_kicks),
                               static_cast<double>(c.impacts_at_instant),
                               c.max_overlap_rod_rod,
                               c.max_overlap_rod_plate};
    const Ledger& ledger = c.ledger;
    for (const ExactSum* sum : {&ledger.lost_rod_rod, &ledger.lost_surfaces, &ledger.given, &ledger.noise,
                                &ledger.momentum[0], &ledger.momentum[1], &ledger.momentum[2]})
      values.push_back(sum->value());
    return values;
  };
  return all(a) == all(b);
}

/// Steps on 2 and 4 threads, shared as finely as can be, give the same as on one. Not for long: threads wait for each
/// other in every tick. Returns what differed, or an empty string.
inline std::string compare_threads(Scene scene, Tick ticks) {
  auto one = Simulation::start(scene);
  if (!one) return "";
  if (one->advance_to(ticks)) return "";
  for (const int n_threads : {2, 4}) {
    auto several = Simulation::start(scene);
    several->use_threads(n_threads, 1);
    if (several->advance_to(ticks)) return "trouble on several threads only";
    if (one->state_hash() != several->state_hash()) return "states differ on " + std::to_string(n_threads) + " threads";
    if (!same(one->world().counters, several->world().counters))
      return "counters differ on " + std::to_string(n_threads) + " threads";
  }
  return "";
}

/// Steps both, compares the hashes at several ticks, and once more after a checkpoint and restart at tick `stop`.
/// Returns what differed, or an empty string.
inline std::string compare(Scene scene, Tick ticks, Tick stop) {
  scene.engine = Engine::kReference;
  auto reference = Simulation::start(scene);
  if (!reference) return "";  // does not fit: nothing to compare
  scene.engine = Engine::kScheduled;
  auto scheduled = Simulation::start(scene);
  std::vector<Tick> looks{1, 2, stop, ticks / 2, ticks};
  std::sort(looks.begin(), looks.end());
  for (const Tick k : looks) {
    const auto trouble_r = reference->advance_to(k);
    const auto trouble_s = scheduled->advance_to(k);
    if (trouble_r.has_value() != trouble_s.has_value())
      return "only one of them met trouble by tick " + std::to_string(k);
    if (trouble_r)
      return trouble_r->tick == trouble_s->tick && trouble_r->rods == trouble_s->rods ? "" : "different trouble";
    if (reference->state_hash() != scheduled->state_hash()) return "states differ at tick " + std::to_string(k);
    if (!same(reference->world().counters, scheduled->world().counters))
      return "counters differ at tick " + std::to_string(k);
    if (k == stop) scheduled = Simulation::resume(scene, scheduled->checkpoint());
  }
  return "";
}

}  // namespace shaken::test
