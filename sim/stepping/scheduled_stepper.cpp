#include "sim/stepping/scheduled_stepper.h"

#include <algorithm>
#include <utility>

#include "sim/tick/rod_impacts.h"

namespace shaken {
ScheduledStepper::ScheduledStepper(const World& world, int n_threads, int grain)
    : rules_(world),
      search_(rules_),
      neighbors_(world.species, world.shape_of_rod, world.system.box(), NeighborList::kSkin),
      pairs_(world.rods.size(), world.system.dt, n_threads),
      loops_(n_threads),
      grain_(static_cast<std::size_t>(grain)),
      rods_(rules_, static_cast<std::size_t>(n_threads)),
      surfaces_(world, neighbors_, rods_, shares_),
      upkeep_(neighbors_, pairs_, rods_, shares_),
      detection_(search_, neighbors_, pairs_, rods_, shares_),
      storing_(search_, neighbors_, pairs_, rods_, shares_),
      bounding_(search_, pairs_, rods_, loops_) {
  const std::size_t n_shares = shares_.size();
  for (std::size_t w = 0; w < n_shares; ++w) {
    shares_[w].number = w;
    shares_[w].overspent.resize(n_shares);
  }
}

std::size_t ScheduledStepper::bytes() const {
  std::size_t bytes = neighbors_.bytes() + rods_.bytes() + pairs_.bytes() + surfaces_.bytes() + upkeep_.bytes() +
                      detection_.bytes() + storing_.bytes() + bounding_.bytes() + heap_bytes(shares_);
  for (const Share& share : shares_) bytes += share.bytes();
  return bytes;
}

WorkCounts ScheduledStepper::work_counts() const {
  WorkCounts counts;
  for (const Share& share : shares_) counts.add(share.counts);
  return counts;
}

void ScheduledStepper::share_where_faster(PhaseTimes::Clock clock) {
  if (shares_.size() > 1) trial_.use(clock);
}

/// By how much there was to do in the tick before.
void ScheduledStepper::choose_sharing() {
  std::size_t n_visits = 0;  // and bounds
  for (const Share& share : shares_) n_visits += share.visited.size() + share.searched.size() + share.to_bound.size();
  const bool is_faster = trial_.next_tick();
  loops_.set_shared(is_faster && n_visits >= grain_ * shares_.size());
}

std::optional<NumericalTrouble> ScheduledStepper::step(World& world, Tick now) {
  phase_times.start();
  choose_sharing();

  // 1. surfaces
  const PlateState plates = world.plates.at(now);
  in_loop([&](Share& share) { surfaces_.meet_due(world, plates, now, share); });
  if (auto trouble = surfaces_.gather(world, shares_)) return trouble;
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
    lap(share, Phase::kShortening);
    surfaces_.schedule(world, now, share);
    lap(share, Phase::kRodBounds);
  });
  if (std::ranges::none_of(shares_, &Share::has_pairs)) return {};
  in_loop([&](Share& share) {
    bounding_.shorten(now, share);
    lap(share, Phase::kShortening);
    bounding_.bound_flights(world, now, share);
  });
  in_loop([&](Share& share) { bounding_.schedule(now, share); });
  phase_times.lap(Phase::kPairBounds);
  return {};
}

}  // namespace shaken
