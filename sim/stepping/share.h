#pragma once

#include <algorithm>
#include <vector>

#include "base/core/heap_bytes.h"
#include "sim/bounds/hull_safe_time.h"
#include "sim/bounds/plate_safe_time.h"
#include "sim/stepping/work_counts.h"
#include "sim/tick/tick.h"

namespace shaken {

/// One thread's share: the rods and pairs that belong to it, in lists of one tick.
struct alignas(64) Share {
  std::size_t number = 0;
  WorkCounts counts;

  // what phases hand on to each other: see the table of loops in scheduled_stepper.h
  std::vector<int> visited;                 ///< rods at which surfaces were looked for
  std::vector<int> hit;                     ///< of these, hit by a surface; later also those that other rods hit
  std::vector<int> to_place;                ///< rods whose skin budget is used up: their pairs are to be found anew
  std::vector<int> failed;                  ///< rods whose motion after the surfaces is numerical trouble
  std::vector<int> searched;                ///< pairs searched for contacts, and those gained: all need a bound
  std::vector<int> apart;                   ///< pairs that came up but cannot touch yet: they need a bound only
  std::vector<int> to_schedule;             ///< rods that need a bound on the time to the next surface
  std::vector<std::vector<int>> overspent;  ///< (n_shares) pairs of each share whose budgets hits overspent
  std::vector<int> to_bound;                ///< pairs that need a bound

  // what phases keep to themselves: surfaces,
  std::vector<int> polled;  ///< rods that are due at the next tick, without a bound
  Counters counters;
  std::optional<NumericalTrouble> trouble;  ///< that of the first rod
  PlateLanes plate_lanes{};
  // the upkeep of neighbours, detection,
  std::vector<int> near;              ///< rods near each of `to_place`, one after the other
  std::vector<std::size_t> near_end;  ///< where those of each end
  std::vector<PairContact> contacts;
  std::vector<int> toggled;  ///< pairs that began or ceased to touch
  std::vector<BeadContact> beads;
  Pose other_pose{};
  // the bounds of pairs
  std::vector<int> polled_pairs;     ///< of rods at rest: to be searched at the next tick without a bound
  std::vector<int> to_bound_flight;  ///< rods of `to_bound`, of whatever share
  PairLanes pair_lanes{};
  std::vector<int> to_pose;  ///< rods, for detection too

  bool has_pairs() const {
    return !searched.empty() || !apart.empty() ||
           std::ranges::any_of(overspent, [](const auto& pairs) { return !pairs.empty(); });
  }
  std::size_t bytes() const {
    std::size_t bytes =
        heap_bytes(visited, hit, to_place, failed, searched, apart, to_schedule, overspent, to_bound, polled, near,
                   near_end, contacts, toggled, beads, polled_pairs, to_bound_flight, to_pose);
    for (const std::vector<int>& pairs : overspent) bytes += heap_bytes(pairs);
    return bytes;
  }
};

}  // namespace shaken
