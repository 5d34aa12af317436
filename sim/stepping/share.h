// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "base/core/heap_bytes.h"
#include "sim/bounds/hull_safe_time.h"
#include "sim/stepping/work_counts.h"
#include "sim/tick/tick.h"

namespace shaken {

/// One thread's share: the rods and pairs that belong to it, in the lists that phases of a tick hand on to each other.
/// The table of loops in scheduled_stepper.h says who reads and who leaves each.
struct alignas(64) Share {
  std::size_t number = 0;
  WorkCounts counts;
  std::vector<int> visited;                 ///< rods at which surfaces were looked for
  std::vector<int> hit;                     ///< of these, hit by a surface; later also those that other rods hit
  std::vector<int> to_place;                ///< rods whose skin budget is used up: their pairs are to be found anew
  std::vector<int> failed;                  ///< rods whose motion after the surfaces is numerical trouble
  std::vector<int> searched;                ///< pairs whose contacts were looked for
  std::vector<int> to_schedule;             ///< rods that need a bound on the time to the next surface
  std::vector<std::vector<int>> overspent;  ///< (n_shares) pairs of each share whose budgets hits overspent
  std::vector<int> to_bound;                ///< pairs that need a bound
  // scratch
  std::vector<int> polled, to_bound_motion, to_pose;
  PairLanes pair_lanes{};

  bool has_pairs() const {
    return !searched.empty() || std::ranges::any_of(overspent, [](const auto& pairs) { return !pairs.empty(); });
  }
  std::size_t bytes() const {
    std::size_t bytes = heap_bytes(visited, hit, to_place, failed, searched, to_schedule, overspent, to_bound, polled,
                                   to_bound_motion, to_pose);
    for (const std::vector<int>& pairs : overspent) bytes += heap_bytes(pairs);
    return bytes;
  }
};

}  // namespace shaken
