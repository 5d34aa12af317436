// SPDX-License-Identifier: MIT
#pragma once

#include "sim/motion/flight.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken {

/// How much further a rod may move before the neighbour list may be incomplete. It is measured now and then
/// (NeighborList::slack) and counted down by the rod's speed in between.
class SkinBudget {
 public:
  /// A rod this close to the end of its budget is placed anew rather than being watched every tick [mm].
  static constexpr float kLeast = 0.003F;

  void measure(const NeighborList& list, int rod, const Pose& pose, Tick now);
  /// At least [mm].
  float left(Tick now, double dt) const {
    return left_ - speed_ * (static_cast<float>(now - at_) * static_cast<float>(dt));
  }

  /// Ticks after `now` for which the list certainly covers the rod, at most `horizon`. Counts down at the flight's
  /// speed from then on. `pull`: acceleration along the plates [mm/s^2]; the flight may have begun before.
  Tick covered_ticks(const NeighborList& list, int rod, const Flight& flight, const Pose& pose, double half_length,
                     Tick now, double dt, Tick horizon, double pull);
  /// Counts down at what the flight can take at most, for less work than covered_ticks and less exactly: for a rod that
  /// is visited at the next tick whatever comes.
  void cover_tick(const Flight& flight, double half_length, Tick now, double dt, double pull);

 private:
  float left_ = 1e30F;  ///< at `at_`, at least [mm]
  float speed_ = 0;     ///< at which it shrinks, at most [mm/s]
  Tick at_ = -1;
};

}  // namespace shaken
