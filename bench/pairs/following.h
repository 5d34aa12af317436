// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sim/bounds/velocity_jump.h"
#include "sim/schedule/pair_schedule.h"
#include "sim/schedule/pair_search.h"
#include "sim/simulation.h"

namespace shaken::bench {

/// Does with some pairs of rods what the scheduled stepper does with all of them.
class Following {
 public:
  enum class Event : std::uint8_t { kRanOut, kTightened, kRenewed };
  /// What happens to a pair at a tick.
  struct Bounded {
    int pair;
    Event event;
    bool by_beads;  ///< of a new bound: beads were looked at
    double safe;    ///< for how long nothing can happen from then on [s]
  };

  /// Keeps references to both.
  Following(const Simulation& simulation, const std::vector<PairRods>& pairs);

  /// What happens to the pairs at the simulation's present tick. To be called at each tick; at the first, every bound
  /// is new.
  const std::vector<Bounded>& look();

 private:
  void look_at(int p);
  void renew(int p, Bounded& bounded);
  VelocityJump change(int i) const;

  const World& world_;
  const std::vector<PairRods>& followed_;
  TickRules rules_;
  PairSearch search_;
  PairSchedule pairs_;
  std::vector<Flight> before_;
  std::vector<RodAtTick> rods_;
  std::vector<FlightBound> motions_;
  PairLanes lanes_{};
  std::vector<std::int32_t> due_;
  std::vector<bool> is_due_;
  std::vector<bool> is_used_up_;  ///< hits have taken more of the gap than they may
  std::vector<Bounded> happened_;
};

/// Gap of the nearest beads of two rods of the first species, in the nearest image; negative where they overlap [mm].
double gap_of(const PairRods& pair, const Snapshot& now, const World& world);

/// Pairs with a smaller gap than `within` [mm] now.
std::vector<PairRods> near_pairs(const Simulation& simulation, double within);

/// Time until the nearest beads of two rods in free flight touch, in the nearest image; `horizon` if it is no shorter
/// [s]. Steps ahead by the time in which the rods, at their fastest, could close the gap. Of the first species.
double time_to_contact(const World& world, int i, int j, double horizon);

}  // namespace shaken::bench
