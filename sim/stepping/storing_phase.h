#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/bounds/velocity_jump.h"
#include "sim/schedule/pair_search.h"
#include "sim/stepping/rod_states.h"
#include "sim/stepping/share.h"

namespace shaken {

/// Phase 4 of a tick, and its price: rods that were hit begin new flights, and each hit spends of the budgets of its
/// rod's pairs. Keeps references.
class StoringPhase {
 public:
  StoringPhase(const PairSearch& search, const NeighborList& neighbors, PairSchedule& pairs, RodStates& rods,
               std::vector<Share>& shares)
      : search_(search), neighbors_(neighbors), pairs_(pairs), rods_(rods), shares_(shares) {
    jumps_.resize(rods.marks.size());
  }

  /// Lists the rods that other rods hit. Returns trouble if any rod that was hit is in it: the world must then stay as
  /// it was before the tick.
  std::optional<NumericalTrouble> check_hit(std::span<const PairContact> contacts, Tick now) {
    std::optional<NumericalTrouble> first;
    const auto check = [&](int i) {
      const RodAtTick& rod = rods_.at_tick[i];
      if (has_sound_motion(rod, rods_.rules) || (first && first->rods.front() <= i)) return;
      first = motion_trouble(i, rod, now, rods_.rules);
    };
    for (Share& share : shares_) {
      share.to_schedule.clear();
      for (const int i : share.failed) check(i);
      share.failed.clear();
    }
    for (const PairContact& contact : contacts) {
      for (const int i : {contact.i, contact.j}) {
        if (!rods_.at_tick[i].changed) continue;
        check(i);
        Share& share = shares_[rods_.owners[i]];
        RodStates::Marks& marks = rods_.marks[i];
        if (std::exchange(marks.hit_at, now) != now) share.hit.push_back(i);
        if (std::exchange(marks.scheduled_at, now) != now) share.to_schedule.push_back(i);
      }
    }
    return first;
  }

  /// Begins new flights of the share's rods that were hit.
  void begin_flights(World& world, Tick now, Share& share) {
    const TickRules& rules = rods_.rules;
    const double pull = rules.gravity.along_size();
    for (const int i : share.hit) {
      const RodAtTick& rod = rods_.at_tick[i];
      Flight& flight = world.rods[i];
      const Before before{velocity_at(flight, now, rules), flight.precession, flight.rate};
      store(i, flight, rod, now, rules);
      if (rod.displaced) rods_.skin_budgets[i].measure(neighbors_, i, rod.pose, now);
      const double half_length = rules.species_of(i).half_length;
      if (rods_.marks[i].hit_again_at == now)
        rods_.skin_budgets[i].cover_tick(flight, {rules.dt, pull, half_length}, now);
      note_jump(i, before, flight, half_length);
    }
  }

  /// Subtracts from each budget of the share's rods what this tick's hits may close of the gap.
  [[gnu::flatten]] void spend_budgets(Tick now, Share& share) {
    share.counts.count(WorkKind::kVelocityJumps, std::ssize(share.hit));
    share.to_bound.clear();
    const bool alone = shares_.size() == 1;
    const auto ask = [&](int i) { pairs_.prefetch_rod(i); };
    for_each_prefetched(share.hit, ask, [&](int i) {
      pairs_.spend(i, jumps_[i], now, [&](int p) {
        pairs_.prefetch(p);
        share.overspent[alone ? 0 : static_cast<std::size_t>(pairs_.owner(p))].push_back(p);
      });
    });
  }

  std::size_t bytes() const { return heap_bytes(jumps_); }

 private:
  /// How a rod moved at the tick before it was hit.
  struct Before {
    Vec3 velocity, precession;
    double rate;
  };

  /// Notes what the hits on a rod did to its motion.
  [[gnu::always_inline]] void note_jump(int i, const Before& before, const Flight& flight, double half_length) {
    const auto slow = static_cast<double>(search_.slow_speed());
    const auto in_plane = [](const Vec3& v) { return std::max(std::abs(v.x()), std::abs(v.y())); };
    const RodAtTick& rod = rods_.at_tick[i];
    VelocityJump& jump = jumps_[i];
    // one that is fast may come near another image, which the bound on the gap leaves out
    if (in_plane(flight.velocity) >= slow) {
      jump = VelocityJump::unknown();
    } else if (rod.displaced) {
      const Pose& undisplaced = rods_.flight_poses[i];
      const Vec3 turning = flight.precession.cross(flight.director) - before.precession.cross(undisplaced.director);
      jump = VelocityJump(flight.velocity - before.velocity, turning, before.rate, flight.rate, half_length);
      const Vec3 shift = rod.pose.position - undisplaced.position;
      jump.displace(shift, rod.pose.director - undisplaced.director, half_length);
      // so may one that was fast between two hits of this tick, which moved it by more than a slow one flies meanwhile
      if (in_plane(shift) >= slow * rods_.rules.dt) jump = VelocityJump::unknown();
    } else {
      const Vec3 turning = (flight.precession - before.precession).cross(flight.director);
      jump = VelocityJump(flight.velocity - before.velocity, turning, before.rate, flight.rate, half_length);
    }
  }

  const PairSearch& search_;
  const NeighborList& neighbors_;
  PairSchedule& pairs_;
  RodStates& rods_;
  std::vector<Share>& shares_;
  std::vector<VelocityJump> jumps_;  ///< (n_rods) of the rods that were hit in this tick
};

}  // namespace shaken
