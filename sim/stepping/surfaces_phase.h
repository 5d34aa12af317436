#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/bounds/surface_safe_ticks.h"
#include "sim/schedule/timing_wheel.h"
#include "sim/stepping/rod_states.h"
#include "sim/stepping/share.h"
#include "sim/tick/plate_impacts.h"
#include "sim/tick/surface_impacts.h"

namespace shaken {

/// Phase 1 of a tick, and the schedule of its visits: base, lid, side walls and posts against the rods that may be in
/// one of them. Keeps references.
class SurfacesPhase {
 public:
  /// Every rod is visited at the first tick.
  SurfacesPhase(const World& world, const NeighborList& neighbors, RodStates& rods, std::vector<Share>& shares)
      : meets_in_lanes_(lanes_know(world.system)),
        neighbors_(neighbors),
        rods_(rods),
        wheel_(world.rods.size(), static_cast<int>(shares.size())) {
    for (std::size_t i = 0; i < world.rods.size(); ++i) shares[rods.owners[i]].polled.push_back(static_cast<int>(i));
  }

  /// Visits the share's rods that are due.
  void meet_due(const World& world, const PlateState& plates, Tick now, Share& share) {
    share.visited.clear();
    share.hit.clear();
    share.visited.swap(share.polled);
    wheel_.pop(now, share.visited, static_cast<int>(share.number));
    const Visits visits{neighbors_, rods_, world, plates, now, share};
    if (meets_in_lanes_ && share.visited.size() > 1) {
      visits.in_lanes();
    } else {
      for_each_prefetched(
          share.visited, [&](int i) { visits.ask(i); }, [&](int i) { visits.visit(i); });
    }
    share.counts.count(WorkKind::kRodsVisited, std::ssize(share.visited));
    share.counts.count(WorkKind::kRodsHit, std::ssize(share.hit));
    share.counts.count(WorkKind::kRodsPlaced, std::ssize(share.to_place));
  }

  /// Adds what the visits counted to the world's counters. Returns the trouble of the first rod that has any.
  std::optional<NumericalTrouble> gather(World& world, std::vector<Share>& shares) {
    std::optional<NumericalTrouble> first;
    for (Share& share : shares) {
      if (share.visited.empty()) continue;
      world.counters.add(share.counters);
      share.counters = {};
      keep_first(first, share.trouble);
    }
    return first;
  }

  /// Schedules the next visits to the share's rods that were visited or hit.
  void schedule(const World& world, Tick now, Share& share) {
    // A rod that a surface hits, and that was hit in the tick before, is as good as sure to be hit in the next tick,
    // too (four of five visits, 99 % of the time), and needs no bound to know it.
    for (const int i : share.visited) {
      if (rods_.marks[i].hit_again_at == now) {
        share.polled.push_back(i);
      } else {
        share.to_schedule.push_back(i);
      }
    }
    share.counts.count(WorkKind::kRodsPolled, std::ssize(share.polled));
    share.counts.count(WorkKind::kRodsBounded, std::ssize(share.to_schedule));
    constexpr Tick kHorizon = TimingWheel::horizon() - 1;
    const TickRules& rules = rods_.rules;
    const double pull = rules.gravity.along_size();
    const auto groups = rods_.by_shape();
    groups.sort(share.to_schedule);
    groups.in_lanes(share.to_schedule, [&](std::span<const int> rods) {
      Tick ticks[kLanes];
      for (const int i : rods) neighbors_.prefetch_place(i);
      off_surface_ticks(rods, world, rods_.at_tick, now, kHorizon, rules, share.plate_lanes, ticks);
      for (std::size_t lane = 0; lane < rods.size(); ++lane) {
        const int i = rods[lane];
        const SkinBudget::Steps steps{rules.dt, pull, rules.species_of(i).half_length};
        const Tick covered = rods_.skin_budgets[i].covered_ticks(neighbors_, i, world.rods[i], rods_.at_tick[i].pose,
                                                                 steps, now, kHorizon);
        wheel_.set(i, now + 1 + std::min(ticks[lane], covered), static_cast<int>(share.number));
      }
    });
  }

  std::size_t bytes() const { return wheel_.bytes(); }

 private:
  static void keep_first(std::optional<NumericalTrouble>& first, const std::optional<NumericalTrouble>& other) {
    if (other && (!first || other->rods < first->rods)) first = other;
  }

  /// The visits of one share at a tick.
  struct Visits {
    const NeighborList& neighbors;
    RodStates& rods;
    const World& world;
    const PlateState& plates;
    Tick now;
    Share& share;
    const TickRules& rules = rods.rules;

    /// The plates for several rods of one shape at a time.
    void in_lanes() const {
      const auto groups = rods.by_shape();
      groups.sort(share.visited);
      const std::span<const int> due = share.visited;
      const auto ask_for_eight = [&](std::size_t first) {
        for (std::size_t k = first; k < std::min(due.size(), first + lanes::kDoubleLanes); ++k) ask(due[k]);
      };
      ask_for_eight(0);
      const auto meet_and_ask = [&](std::span<const int> some) {
        ask_for_eight(static_cast<std::size_t>(some.data() - due.data()) + some.size());
        visit_together(some);
      };
      groups.in_lanes(due, meet_and_ask, lanes::kDoubleLanes);
    }

    void ask(int i) const {
      prefetch(world.rods[i]);
      prefetch(rods.at_tick[i]);
      prefetch(rods.marks[i]);
      prefetch(rods.skin_budgets[i]);
    }

    void visit(int i) const {
      rods.pose(i, world, now);
      begin(i);
      keep_first(share.trouble, meet_surfaces(i, rods.at_tick[i], world.rods[i], plates, now, rules, share.counters));
      end(i);
    }

    void visit_together(std::span<const int> some) const {
      const std::uint32_t unresolved =
          meet_plates_in_lanes(some, world.rods, rods.at_tick, rods.flight_poses, plates, now, rules, share.counters);
      for (std::size_t lane = 0; lane < some.size(); ++lane) {
        const int i = some[lane];
        if ((unresolved >> lane & 1U) != 0) {
          visit(i);
          continue;
        }
        begin(i);
        if (rules.has_uprights())
          keep_first(share.trouble,
                     meet_uprights(i, rods.at_tick[i], world.rods[i], plates, now, rules, share.counters));
        end(i);
      }
    }

    /// Before any surface displaces the rod.
    void begin(int i) const {
      rods.marks[i].posed_at = rods.marks[i].scheduled_at = now;
      SkinBudget& budget = rods.skin_budgets[i];
      if (budget.remaining(now, rules.dt) >= SkinBudget::kLeast) return;
      budget.measure(neighbors, i, rods.flight_pose(i), now);
      if (budget.remaining(now, rules.dt) < SkinBudget::kLeast) share.to_place.push_back(i);
    }

    void end(int i) const {
      if (!rods.at_tick[i].changed) return;
      RodStates::Marks& marks = rods.marks[i];
      if (marks.hit_at == now - 1) marks.hit_again_at = now;
      marks.hit_at = now;
      share.hit.push_back(i);
      if (!has_sound_motion(rods.at_tick[i], rules)) share.failed.push_back(i);
    }
  };

  bool meets_in_lanes_;  ///< plates are met by several rods at a time
  const NeighborList& neighbors_;
  RodStates& rods_;
  TimingWheel wheel_;  ///< of rods
};

}  // namespace shaken
