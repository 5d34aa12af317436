// SPDX-License-Identifier: MIT
#include "sim/stepping/scheduled_stepper.h"

#include <algorithm>
#include <utility>

#include "base/core/heap_bytes.h"
#include "sim/lanes/prefetch.h"
#include "sim/tick/rod_impacts.h"

namespace shaken {
ScheduledStepper::ScheduledStepper(const World& world, int n_threads, int grain)
    : rules_(world),
      search_(rules_),
      neighbors_(world.species, world.shape_of_rod, world.system.box(), NeighborList::kSkin),
      loops_(n_threads),
      grain_(static_cast<std::size_t>(grain)),
      rods_(rules_, static_cast<std::size_t>(n_threads)),
      flight_bounds_(world.rods.size()),
      pairs_(world.rods.size(), world.system.dt, n_threads),
      surfaces_(world, neighbors_, rods_, loops_.shares().size()),
      upkeep_(neighbors_, pairs_, rods_, loops_.shares()),
      detection_(search_, neighbors_, pairs_, rods_, loops_.shares()),
      storing_(search_, neighbors_, pairs_, rods_, loops_.shares()) {
  const std::size_t n_shares = loops_.shares().size();
  for (std::size_t w = 0; w < n_shares; ++w) {
    loops_.shares()[w].number = w;
    loops_.shares()[w].overspent.resize(n_shares);
  }
}

std::size_t ScheduledStepper::bytes() const {
  std::size_t bytes = neighbors_.bytes() + pairs_.bytes() + rods_.bytes() + upkeep_.bytes() + surfaces_.bytes() +
                      detection_.bytes() + storing_.bytes();
  bytes += heap_bytes(flight_bounds_, loops_.shares());
  for (const Share& share : loops_.shares()) bytes += share.bytes();
  return bytes;
}

WorkCounts ScheduledStepper::work_counts() const {
  WorkCounts counts;
  for (const Share& share : loops_.shares()) counts.add(share.counts);
  return counts;
}

void ScheduledStepper::share_where_faster(PhaseTimes::Clock clock) {
  if (loops_.shares().size() > 1) trial_.use(clock);
}

std::optional<NumericalTrouble> ScheduledStepper::step(World& world, Tick now) {
  phase_times.start();
  std::size_t n_visits = 0;  // and bounds, in the tick before
  for (const Share& share : loops_.shares()) {
    n_visits += share.visited.size() + share.searched.size() + share.to_bound.size();
  }
  const bool is_faster = trial_.next_tick();
  loops_.set_shared(is_faster && n_visits >= grain_ * loops_.shares().size());

  // 1. surfaces
  const PlateState plates = world.plates.at(now);
  in_loop([&](Share& share) { surfaces_.meet_due(world, plates, now, share); });
  if (auto trouble = surfaces_.gather(world, loops_.shares())) return trouble;
  phase_times.lap(Phase::kSurfaces);

  // 2. detection
  upkeep_.place_rods(now);
  if (std::exchange(is_new_, false)) upkeep_.first_tick(now);
  phase_times.lap(Phase::kNeighbors);
  in_loop([&](Share& share) {
    upkeep_.find_near(now, share);
    lap(share, Phase::kNeighbors);
    detection_.search_due(world, now, share);
  });
  detection_.gather(world, now);
  phase_times.lap(Phase::kDetection);
  const std::span<const int> gained = upkeep_.replace_pairs();
  phase_times.lap(Phase::kNeighbors);
  detection_.search_gained(gained, world, now);
  detection_.search_touching(world, now);
  phase_times.lap(Phase::kDetection);

  // 3. response
  if (auto trouble = collide_rods(detection_.contacts(), rods_.at_tick, world, now, rules_)) return trouble;
  phase_times.lap(Phase::kResponse);

  // 4. storing
  if (auto trouble = storing_.check_hit(detection_.contacts(), now)) return trouble;
  // ... and what was visited, and what flies differently now, gets new bounds
  in_loop([&](Share& share) {
    storing_.begin_flights(world, now, share);
    lap(share, Phase::kStoring);
    storing_.spend_budgets(now, share);
    lap(share, Phase::kTightening);
    surfaces_.schedule(world, now, share);
    lap(share, Phase::kRodBounds);
  });
  if (std::ranges::none_of(loops_.shares(), &Share::has_pairs)) return {};
  in_loop([&](Share& share) {
    shorten_bounds(now, share);
    bound_motions(world, now, share);
  });
  in_loop([&](Share& share) { schedule_pairs(now, share); });
  return {};
}

/// Lists the pairs that were due, and brings up sooner, or lists, those of whose gaps hits took more than they may.
/// Not in the loop that spends budgets: that one writes rod by rod, this one pair by pair, whose other rod may be
/// another share's.
void ScheduledStepper::shorten_bounds(Tick now, Share& share) {
  share.polled.clear();
  for (const int p : share.searched) {
    // one that has been lost, or is another's by now, is not listed
    if (!pairs_.is_used(p) || static_cast<std::size_t>(pairs_.owner(p)) != share.number) continue;
    if (rules_.rest.matters() && pairs_.keeps_touching(p)) {
      pairs_.poll(p, now);  // rods at rest touch in every tick: a bound would be of no use
      pairs_.list(p, share.polled);
    } else {
      pairs_.list(p, share.to_bound);
    }
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
  for (const int p : share.polled) pairs_.unlist(p);
  share.counts.count(WorkKind::kBoundsShortened, n_shortened);
  lap(share, Phase::kTightening);
}

void ScheduledStepper::bound_motions(const World& world, Tick now, Share& share) {
  share.to_pose.clear();
  share.to_bound_motion.clear();
  for (const int p : share.to_bound) {
    pairs_.prefetch_bound(p);
    for (const int i : pairs_.rods(p)) {
      if (!loops_.claim(rods_.marks[i].bounded_at, now)) continue;
      share.to_bound_motion.push_back(i);
      if (rods_.claim_pose(i, now)) share.to_pose.push_back(i);
    }
  }
  share.counts.count(WorkKind::kPairsBounded, std::ssize(share.to_bound));
  rods_.pose_all(share.to_pose, world, now);
  const auto ask = [&](int i) { prefetch(flight_bounds_[i]); };
  for_each_prefetched(share.to_bound_motion, ask, [&](int i) {
    const Flight& flight = world.rods[i];
    flight_bounds_[i] =
        flight_bound(flight, velocity_at(flight, now, rules_), rods_.at_tick[i].pose.director, search_.slow());
  });
  lap(share, Phase::kPairBounds);
}

void ScheduledStepper::schedule_pairs(Tick now, Share& share) {
  const auto n_shapes = static_cast<int>(rules_.species.size());
  const Groups groups(n_shapes > 1, [this, n_shapes](int p) {
    const auto& [i, j] = pairs_.rods(p);
    return shape_of(i) * n_shapes + shape_of(j);
  });
  groups.sort(share.to_bound);
  groups.in_lanes(share.to_bound, [&](std::span<const int> pairs) { bound_pairs(pairs, now, share); });
  lap(share, Phase::kPairBounds);
}

/// For up to kLanes pairs.
void ScheduledStepper::bound_pairs(std::span<const int> pairs, Tick now, Share& share) {
  PairRods rods[kLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) rods[lane] = pairs_.rods(pairs[lane]);
  PairBounds bounds;
  search_.bound({rods, pairs.size()}, rods_.at_tick, flight_bounds_, share.pair_lanes, bounds);
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    // Whether a pair is touching was found where free flight had brought its rods. Displaced since, they may overlap
    // and recede without being marked: to be visited again at once.
    const auto& [i, j] = rods[lane];
    const bool unmarked = bounds.may_overlap[lane] && (rods_.at_tick[i].displaced || rods_.at_tick[j].displaced);
    share.counts.count(WorkKind::kBoundsByBeads, bounds.by_beads[lane] ? 1 : 0);
    share.counts.count(WorkKind::kBoundsOfNoTick, bounds.ticks[lane] == 0 ? 1 : 0);
    pairs_.unlist(pairs[lane]);
    pairs_.set_bound(pairs[lane], now, unmarked ? 0 : bounds.ticks[lane], bounds.direction[lane],
                     unmarked ? GapBound{} : bounds.gap[lane]);
  }
}

}  // namespace shaken
