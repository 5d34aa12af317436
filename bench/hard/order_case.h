// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "bench/hard/outcome.h"
#include "bench/hard/scene_cases.h"

namespace shaken::bench {

/// The three scenes order-sorted, order-reversed and order-shuffled, of which the statistics are compared.
inline constexpr const char* kOrderCase = "order";

/// How much is spent on the question, and what counts as an answer.
struct OrderEffort {
  int replicas = 15;  ///< runs of each scene, which differ in their seed; each gives one sample of every mean
  double seconds =
      1e9;           ///< simulated, of a replica; that of the scene if it is less. The first eleventh is not counted
  double slack = 1;  ///< the bounds are so many times wider, and say so
};

/// Means of one scene under three orders of the contacts of a tick. Each must be shown to be the same within its bound:
/// what is left open for want of replicas does not hold.
HardCase run_order_case(const std::filesystem::path& folder, const OrderEffort& effort, const Watch& watch);

}  // namespace shaken::bench
