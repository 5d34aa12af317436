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
  float remaining(Tick now, double dt) const {
    return remaining_ - speed_ * (static_cast<float>(now - at_) * static_cast<float>(dt));
  }

  /// What stays the same from tick to tick, for rods of one shape.
  struct Steps {
    double dt;           ///< [s]
    double pull;         ///< acceleration along the plates [mm/s^2]
    double half_length;  ///< of the rod [mm]
  };
  /// Ticks after `now` for which the list certainly covers the rod, at most `horizon`. Counts down at the flight's
  /// speed from then on; the flight may have begun before.
  Tick covered_ticks(const NeighborList& list, int rod, const Flight& flight, const Pose& pose, const Steps& steps,
                     Tick now, Tick horizon);
  /// Counts down at what the flight can take at most, for less work than covered_ticks and less exactly: for a rod that
  /// is visited at the next tick whatever comes.
  void cover_tick(const Flight& flight, const Steps& steps, Tick now);

 private:
  void count_down(Tick now, double dt);

  float remaining_ = 1e30F;  ///< at `at_`, at least [mm]
  float speed_ = 0;          ///< at which it shrinks, at most [mm/s]
  Tick at_ = -1;
};

}  // namespace shaken
