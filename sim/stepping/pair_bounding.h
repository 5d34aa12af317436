#pragma once

#include <span>
#include <vector>

#include "sim/schedule/pair_search.h"
#include "sim/stepping/rod_states.h"
#include "sim/stepping/share.h"

namespace shaken {

/// Brings pairs up again in time: shortens bounds whose budgets hits have overspent, and makes new ones. Keeps
/// references.
class PairBounding {
 public:
  PairBounding(const PairSearch& search, PairSchedule& pairs, RodStates& rods, SharedLoops<Share>& loops)
      : search_(search), pairs_(pairs), rods_(rods), loops_(loops), flight_bounds_(rods.marks.size()) {}

  /// Lists the share's pairs that came up, and shortens the bounds of, or lists, those that are overspent. Not in
  /// the loop that spends budgets, which writes those of one rod, where this one writes those of both rods of a pair.
  void shorten(Tick now, Share& share) {
    share.polled_pairs.clear();
    // one that has been lost, or is another's by now, is not listed
    const auto is_own = [&](int p) {
      return pairs_.is_used(p) && static_cast<std::size_t>(pairs_.owner(p)) == share.number;
    };
    for (const int p : share.searched) {
      if (!is_own(p)) continue;
      if (rods_.rules.rest.matters() && pairs_.keeps_touching(p)) {
        pairs_.poll(p, now);  // rods at rest touch in every tick: a bound would be of no use
        pairs_.list(p, share.polled_pairs);
      } else {
        pairs_.list(p, share.to_bound);
      }
    }
    for (const int p : share.apart) {
      if (is_own(p)) pairs_.list(p, share.to_bound);
    }
    share.counts.count(WorkKind::kBoundsWhenDue, std::ssize(share.to_bound));
    std::int64_t n_shortened = 0;
    for (Share& from : loops_.shares()) {
      std::vector<int>& overspent = from.overspent[share.number];
      const auto ask = [&](int p) { pairs_.prefetch_bound(p); };
      for_each_prefetched(overspent, ask, [&](int p) {
        if (pairs_.is_listed(p)) return;
        if (pairs_.shorten_bound(p, now)) {
          ++n_shortened;
        } else {
          pairs_.list(p, share.to_bound);
          for (const int i : pairs_.rods(p)) prefetch(rods_.marks[i]);
        }
      });
      overspent.clear();
    }
    for (const int p : share.polled_pairs) pairs_.unlist(p);
    share.counts.count(WorkKind::kBoundsShortened, n_shortened);
  }

  /// Bounds the flights of the rods of pairs `to_bound`, each once: whichever share claims it first.
  void bound_flights(const World& world, Tick now, Share& share) {
    share.to_pose.clear();
    share.to_bound_flight.clear();
    for (const int p : share.to_bound) {
      pairs_.prefetch_bound(p);
      for (const int i : pairs_.rods(p)) {
        if (!loops_.claim(rods_.marks[i].bounded_at, now)) continue;
        share.to_bound_flight.push_back(i);
        if (rods_.claim_pose(i, now)) share.to_pose.push_back(i);  // safe: here is only who has the claim
      }
    }
    share.counts.count(WorkKind::kPairsBounded, std::ssize(share.to_bound));
    rods_.pose_all(share.to_pose, world, now);
    const auto ask = [&](int i) { prefetch(flight_bounds_[i]); };
    for_each_prefetched(share.to_bound_flight, ask, [&](int i) {
      const Flight& flight = world.rods[i];
      flight_bounds_[i] = flight_bound(flight, velocity_at(flight, now, rods_.rules), rods_.at_tick[i].pose.director,
                                       search_.slow_speed());
    });
  }

  /// Bounds and schedules pairs `to_bound`.
  void schedule(Tick now, Share& share) {
    const std::vector<std::uint8_t>& shapes = rods_.rules.shape_of_rod;
    const auto n_shapes = static_cast<int>(rods_.rules.species.size());
    const Groups groups(n_shapes > 1, [&](int p) {
      const auto& [i, j] = pairs_.rods(p);
      return shapes[i] * n_shapes + shapes[j];
    });
    groups.sort(share.to_bound);
    groups.in_lanes(share.to_bound, [&](std::span<const int> pairs) { bound(pairs, now, share); });
  }

  std::size_t bytes() const { return heap_bytes(flight_bounds_); }

 private:
  /// For up to kLanes pairs.
  void bound(std::span<const int> pairs, Tick now, Share& share) {
    PairRods rods[kLanes];
    for (std::size_t lane = 0; lane < pairs.size(); ++lane) rods[lane] = pairs_.rods(pairs[lane]);
    PairBound bounds[kLanes];
    search_.bound({rods, pairs.size()}, rods_.at_tick, flight_bounds_, share.pair_lanes, bounds);
    for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
      // Whether a pair is touching was found where free flight had brought its rods. Displaced since, they may overlap
      // and recede without being marked: to be visited again at once.
      const auto& [i, j] = rods[lane];
      const PairBound& bound = bounds[lane];
      const bool unmarked = bound.may_overlap && (rods_.at_tick[i].displaced || rods_.at_tick[j].displaced);
      share.counts.count(WorkKind::kBoundsByBeads, bound.by_beads ? 1 : 0);
      share.counts.count(WorkKind::kBoundsOfNoTick, bound.ticks == 0 ? 1 : 0);
      pairs_.unlist(pairs[lane]);
      pairs_.set_bound(pairs[lane], now, unmarked ? 0 : bound.ticks, bound.direction,
                       unmarked ? GapBound{} : bound.gap);
    }
  }

  const PairSearch& search_;
  PairSchedule& pairs_;
  RodStates& rods_;
  SharedLoops<Share>& loops_;
  std::vector<FlightBound> flight_bounds_;  ///< (n_rods)
};

}  // namespace shaken
