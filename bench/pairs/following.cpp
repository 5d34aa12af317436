// SPDX-License-Identifier: MIT
#include "bench/pairs/following.h"

#include "bench/nearest_beads.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken::bench {

Following::Following(const Simulation& simulation, const std::vector<PairRods>& pairs)
    : world_(simulation.world()),
      followed_(pairs),
      rules_(world_),
      search_(rules_),
      pairs_(world_.rods.size(), rules_.dt),
      before_(world_.rods),
      rods_(world_.rods.size()),
      motions_(world_.rods.size()),
      is_due_(pairs.size(), true),
      is_used_up_(pairs.size(), false) {
  pairs_.make_room(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) pairs_.add(static_cast<int>(p), pairs[p], 0);
}

const std::vector<Following::Bounded>& Following::look() {
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    rods_[i] = rod_at_tick(world_.rods[i], world_.tick, rules_);
    motions_[i] = flight_bound(world_.rods[i], velocity_at(world_.rods[i], world_.tick, rules_), rods_[i].pose.director,
                               search_.slow());
  }
  due_.clear();
  pairs_.wheel().pop(world_.tick, due_);
  for (const int p : due_) is_due_[p] = !pairs_.defer(p, world_.tick);
  for (int i = 0; i < static_cast<int>(rods_.size()); ++i) {
    if (world_.rods[i].since == world_.tick)
      pairs_.take(i, change(i), world_.tick, [&](int p) { is_used_up_[p] = true; });
  }
  happened_.clear();
  for (int p = 0; p < static_cast<int>(followed_.size()); ++p) look_at(p);
  is_due_.assign(is_due_.size(), false);
  is_used_up_.assign(is_used_up_.size(), false);
  before_ = world_.rods;
  return happened_;
}

void Following::look_at(int p) {
  const auto is_hit = [&](int i) { return world_.rods[i].since == world_.tick; };
  const auto& [i, j] = followed_[p];
  if (is_due_[p]) {
    happened_.push_back({p, Event::kRanOut, false, 0});
  } else if (!is_hit(i) && !is_hit(j)) {
    return;
  } else if (!is_used_up_[p] || pairs_.shorten_bound(p, world_.tick)) {
    happened_.push_back({p, Event::kTightened, false, 0});
  } else {
    happened_.push_back({p, Event::kRenewed, false, 0});
  }
  Bounded& bounded = happened_.back();
  if (bounded.event == Event::kTightened) {
    bounded.safe = (pairs_.ticks_left(p, world_.tick) + 1) * rules_.dt;
  } else {
    renew(p, bounded);
  }
}

void Following::renew(int p, Bounded& bounded) {
  PairBounds bounds;
  search_.bound(std::span(&followed_[p], 1), rods_, motions_, lanes_, bounds);
  pairs_.set_bound(p, world_.tick, bounds.ticks[0], bounds.direction[0], bounds.line[0]);
  bounded.by_beads = bounds.by_beads[0];
  bounded.safe = (bounds.ticks[0] + 1) * rules_.dt;
}

VelocityJump Following::change(int i) const {
  const Flight& flight = world_.rods[i];
  return {flight.velocity - velocity_at(before_[i], world_.tick, rules_),
          flight.precession - before_[i].precession,
          flight.director,
          before_[i].rate,
          flight.rate,
          rules_.species_of(i).half_length,
          0};
}

double gap_of(const PairRods& pair, const Snapshot& now, const World& world) {
  const auto& [i, j] = pair;
  const Vec3 D = nearest_image(now.position[i], now.position[j], world.system.box_side);
  return nearest_beads(world.species.front(), now.director[i], now.director[j], D).gap;
}

std::vector<PairRods> near_pairs(const Simulation& simulation, double within) {
  const World& world = simulation.world();
  const Snapshot now = simulation.snapshot();
  const double reach = 2 * world.species.front().reach() + within;
  std::vector<PairRods> pairs;
  for (int i = 0; i < static_cast<int>(now.n_rods()); ++i) {
    for (int j = i + 1; j < static_cast<int>(now.n_rods()); ++j) {
      const Vec3 D = nearest_image(now.position[i], now.position[j], world.system.box_side);
      if (D.squaredNorm() < reach * reach && gap_of({i, j}, now, world) < within) pairs.push_back({i, j});
    }
  }
  return pairs;
}

double time_to_contact(const World& world, int i, int j, double horizon) {
  const System& system = world.system;
  const Species& species = world.species.front();
  const Flight& a = world.rods[i];
  const Flight& b = world.rods[j];
  const auto flown = [&](const Flight& flight) { return static_cast<double>(world.tick - flight.since) * system.dt; };
  // the centres approach at a constant rate: gravity acts on both alike
  const Vec3 v = b.velocity - a.velocity - system.gravity * (flown(b) - flown(a)) * Vec3::UnitZ();
  const double fastest = v.norm() + species.half_length * (a.rate + b.rate);
  constexpr double kTouching = 1e-5;  // [mm]; what is nearer counts as touching
  double time = 0;
  while (time < horizon) {
    const Pose pose_i = pose_after(a, flown(a) + time, system.gravity);
    const Pose pose_j = pose_after(b, flown(b) + time, system.gravity);
    const Vec3 D = nearest_image(pose_i.position, pose_j.position, system.box_side);
    const double gap = nearest_beads(species, pose_i.director, pose_j.director, D).gap;
    if (gap < kTouching) return time;
    time += gap / (fastest + 1e-9);
  }
  return horizon;
}

}  // namespace shaken::bench
