#pragma once

#include <span>
#include <vector>

#include "sim/bounds/bead_safe_time.h"
#include "sim/bounds/hull_safe_time.h"
#include "sim/schedule/pair_schedule.h"
#include "sim/tick/tick.h"

namespace shaken {

/// Bounds for which beads were looked at hold for so long at most: further ahead they are not worth the work [ticks].
/// Price as in pair_schedule.cpp; 125: 2.4 and 1.0 % more; 500: 0.4 % more, and 0.2 % less.
inline constexpr float kBeadHorizon = 250;

/// Ticks for which nothing can happen to a pair, and what the bound is made from.
struct PairBound {
  int ticks;
  GapBound gap;      ///< for as long as the bound lasts
  bool may_overlap;  ///< beads may overlap already
  bool by_beads;     ///< beads were looked at
  Direction direction;
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

  /// Rods below it along x and y are slow: if the nearest image is near, they meet no other, even where inclined plates
  /// make them faster [mm/s].
  float slow_speed() const { return slow_speed_; }

  /// Bounds for up to kLanes pairs of one pair of species, from the rods as they are at this tick. They hold for free
  /// flight, or as far as budgets allow for hits (PairSchedule::spend).
  void bound(std::span<const PairRods> pairs, const std::vector<RodAtTick>& rods,
             const std::vector<FlightBound>& motion, PairLanes& lanes, PairBound* bounds) const;

 private:
  using Shapes = std::array<std::uint8_t, 2>;
  PairBound bound(const Shapes& shapes, const Vec3& D, const FlightBound& i, const FlightBound& j,
                  const HullSafeTimes& hulls, std::size_t lane) const;

  const TickRules& rules_;
  std::vector<Hull> hulls_;       ///< (n_shapes)
  std::vector<BeadLanes> lanes_;  ///< (n_shapes)
  std::vector<double> reach_;     ///< (n_shapes) [mm]
  float horizon_;                 ///< of all bounds [s]
  float per_dt_;                  ///< ticks per second, rounded down
  float slow_speed_;              ///< that rods must be below now
  float slow_later_;              ///< what they may become in the time that is looked ahead
};

}  // namespace shaken
