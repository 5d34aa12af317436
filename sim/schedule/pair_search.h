// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sim/bounds/bead_safe_time.h"
#include "sim/bounds/hull_safe_time.h"
#include "sim/schedule/pair_schedule.h"
#include "sim/tick/tick.h"

namespace shaken {

/// Bounds for which beads were looked at hold for so long at most: further ahead they are not worth the work [ticks].
inline constexpr float kBeadHorizon = 250;

/// For up to kLanes pairs: ticks for which nothing can happen, and what the bound rests on.
struct PairBounds {
  int ticks[kLanes];
  GapBound gap[kLanes];      ///< for as long as the bound lasts
  bool may_overlap[kLanes];  ///< beads may overlap already
  bool by_beads[kLanes];     ///< beads were looked at
  Direction direction[kLanes];
};

/// Finds the contacts of a pair, and the time before which it can have none.
class PairSearch {
 public:
  /// Keeps a reference to `rules`.
  explicit PairSearch(const TickRules& rules);

  /// Appends the contacts of two rods at these poses; returns whether there are any. `direction` saves most searches:
  /// most pairs are still apart where they last were. `beads` is scratch.
  bool find(const PairRods& pair, const Pose& pose_i, const Pose& pose_j, const Direction& direction,
            std::vector<BeadContact>& beads, std::vector<PairContact>& contacts) const;

  /// Rods that are slower than this along x and y meet no image but the nearest, if that is near, even if inclined
  /// plates make them faster [mm/s].
  float slow() const { return slow_now_; }

  /// Bounds for pairs of one pair of species, from the rods as they are at this tick. They hold for free flight, or as
  /// far as budgets allow for hits (PairSchedule::spend).
  void bound(std::span<const PairRods> pairs, const std::vector<RodAtTick>& rods,
             const std::vector<FlightBound>& motion, PairLanes& lanes, PairBounds& bounds) const;

 private:
  const TickRules& rules_;
  std::vector<Hull> hulls_;       ///< (n_shapes)
  std::vector<BeadLanes> lanes_;  ///< (n_shapes)
  std::vector<double> reach_;     ///< (n_shapes) [mm]
  float slow_;                    ///< what they may become in the time that is looked ahead
  float slow_now_;                ///< so that they do not become faster
};

}  // namespace shaken
