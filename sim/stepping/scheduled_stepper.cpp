// SPDX-License-Identifier: MIT
#include "sim/stepping/scheduled_stepper.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "sim/motion/plate_safe_time.h"

namespace shaken {
namespace {

constexpr double kSkin = 0.3;  ///< of the neighbour list [mm]
/// A rod this close to the end of its slack has the list rebuilt rather than being watched every tick.
constexpr double kLeastSlack = 0.003;
/// Where the hull's bound is shorter than this, the beads' own may be longer: rods interlock.
constexpr Tick kShortBound = 30;
/// Interlocked rods are looked at again within this time: further ahead their bounds are not worth the work.
constexpr Tick kBeadHorizon = 400;

}  // namespace

ScheduledStepper::ScheduledStepper(const World& world)
    : rules_(world),
      hull_(world.species),
      lanes_(world.species),
      allowance_{1.0, world.species.half_length > 0 ? 1.0 / world.species.half_length : 1.0},
      neighbors_(world.species, world.scene.box_side, kSkin),
      rods_(world.rods.size()),
      rod_tick_(world.rods.size(), -1),
      rod_schedule_(world.rods.size()),
      strayed_velocity_(world.rods.size(), 0.0),
      strayed_precession_(world.rods.size(), 0.0),
      poses_(world.rods.size()) {}

void ScheduledStepper::set_due(TimingWheel& wheel, Schedule& schedule, std::int32_t item, Tick due) {
  schedule.due = due;
  if (schedule.queued != kNotQueued && schedule.queued <= due) return;  // will come up in time, and be put off then
  schedule.queued = due;
  wheel.insert(due, item);
}

void ScheduledStepper::take_due(TimingWheel& wheel, std::vector<Schedule>& schedules, Tick now,
                                std::vector<std::int32_t>& due) {
  wheel.pop(now, popped_);
  due.clear();
  for (const std::int32_t item : popped_) {
    Schedule& schedule = schedules[item];
    if (schedule.queued != now) continue;  // an entry that has been overtaken by an earlier one
    schedule.queued = kNotQueued;
    if (schedule.due > now) {
      set_due(wheel, schedule, item, schedule.due);
    } else {
      due.push_back(item);
    }
  }
}

RodAtTick& ScheduledStepper::at_tick(const World& world, int i, Tick now) {
  if (rod_tick_[i] != now) {
    rods_[i] = rod_at_tick(world.rods[i], now, rules_);
    rod_tick_[i] = now;
  }
  return rods_[i];
}

FlightState ScheduledStepper::flight_state(const World& world, int i, Tick now) {
  const Flight& flight = world.rods[i];
  const RodAtTick& rod = at_tick(world, i, now);
  FlightState state;
  state.director = rod.pose.director;
  state.velocity = flight.velocity;
  state.velocity.z() -= rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt);
  state.turning = flight.precession.cross(state.director);
  state.rate2 = flight.rate * flight.rate;
  return state;
}

void ScheduledStepper::schedule_pair(int p, Tick now, double safe_time) {
  const double ticks = std::min(safe_time / rules_.dt * (1.0 - 1e-12), static_cast<double>(TimingWheel::horizon() - 1));
  set_due(pair_wheel_, pair_schedule_[p], p, now + 1 + static_cast<Tick>(ticks));
}

void ScheduledStepper::look_again(const World& world, int p, Tick now) {
  pair_looked_[p] = now;
  PairRecord& pair = pairs_[p];
  const FlightState i = flight_state(world, pair.rod[0], now);
  const FlightState j = flight_state(world, pair.rod[1], now);
  const Vec3 D = nearest_image(rods_[pair.rod[0]].pose.position, rods_[pair.rod[1]].pose.position, rules_.box_side);
  const double horizon = static_cast<double>(TimingWheel::horizon()) * rules_.dt;

  pair.direction = separating_direction(hull_, i.director, hull_, j.director, D);
  pair.axis[0] = {i.director.dot(pair.direction), i.turning.dot(pair.direction), 0.5 * i.rate2, now};
  pair.axis[1] = {j.director.dot(pair.direction), j.turning.dot(pair.direction), 0.5 * j.rate2, now};
  const auto cosine = [](const AxisRecord& axis) { return AxisCosine{axis.c, axis.rate, axis.half_rate2, 0.0}; };
  double safe = hull_safe_time(hull_, cosine(pair.axis[0]), hull_, cosine(pair.axis[1]), D.dot(pair.direction),
                               (j.velocity - i.velocity).dot(pair.direction), allowance_, horizon);
  pair.by_beads = false;
  if (safe < static_cast<double>(kShortBound) * rules_.dt) {
    const double by_beads =
        bead_safe_time(lanes_, i, lanes_, j, D, allowance_, static_cast<double>(kBeadHorizon) * rules_.dt);
    if (by_beads > safe) {
      safe = by_beads;
      pair.by_beads = true;
    }
  }
  schedule_pair(p, now, safe);
}

void ScheduledStepper::renew(const World& world, int p, int side, Tick now) {
  if (pair_looked_[p] == now) return;
  PairRecord& pair = pairs_[p];
  if (pair.by_beads) return look_again(world, p, now);

  const Flight& changed = world.rods[pair.rod[side]];
  pair.axis[side] = {changed.director.dot(pair.direction),
                     changed.precession.cross(changed.director).dot(pair.direction), 0.5 * changed.rate * changed.rate,
                     now};
  Vec3 position[2];
  Vec3 velocity[2];
  for (int s = 0; s < 2; ++s) {
    const Flight& flight = world.rods[pair.rod[s]];
    const double tau = static_cast<double>(now - flight.since) * rules_.dt;
    position[s] = flight.position + flight.velocity * tau;
    position[s].z() -= 0.5 * rules_.gravity * tau * tau;
    velocity[s] = flight.velocity;
    velocity[s].z() -= rules_.gravity * tau;
  }
  const auto cosine = [&](const AxisRecord& axis) {
    return AxisCosine{axis.c, axis.rate, axis.half_rate2, static_cast<double>(now - axis.at) * rules_.dt};
  };
  const double horizon = static_cast<double>(TimingWheel::horizon()) * rules_.dt;
  const double safe = hull_safe_time(hull_, cosine(pair.axis[0]), hull_, cosine(pair.axis[1]),
                                     nearest_image(position[0], position[1], rules_.box_side).dot(pair.direction),
                                     (velocity[1] - velocity[0]).dot(pair.direction), allowance_, horizon);
  // an old direction may have become a poor one
  if (safe < static_cast<double>(kShortBound) * rules_.dt) return look_again(world, p, now);
  schedule_pair(p, now, safe);
}

void ScheduledStepper::schedule_rod(const World& world, int i, Tick now) {
  const Flight& flight = world.rods[i];
  const FlightState state = flight_state(world, i, now);
  const Pose& pose = rods_[i].pose;
  const Tick off_plates =
      plate_safe_ticks(rules_.species, world.plates, pose.position.z(), state.velocity.z(), state.director.z(),
                       state.turning.z(), state.rate2, rules_.gravity, rules_.dt, now, TimingWheel::horizon() - 1);
  // the ends of the flattened segment move no faster than this while |n_xy| is above half of what it is now
  const double flat = std::hypot(state.director.x(), state.director.y());
  const double speed =
      std::hypot(flight.velocity.x(), flight.velocity.y()) + 2.0 * hull_.half_length * flight.rate / flat;
  const double listed =
      std::min(neighbors_.slack(i, pose) / speed, flight.rate > 0 ? 0.5 * flat / flight.rate : kForever);
  const double listed_ticks =
      std::min(std::max(0.0, listed / rules_.dt * (1.0 - 1e-12)), static_cast<double>(off_plates));
  set_due(rod_wheel_, rod_schedule_[i], i, now + 1 + static_cast<Tick>(listed_ticks));
}

void ScheduledStepper::rebuild_pairs(const World& world, Tick now) {
  const int n = static_cast<int>(world.rods.size());
  for (int i = 0; i < n; ++i) poses_[i] = at_tick(world, i, now).pose;
  neighbors_.build(poses_);

  const auto list = neighbors_.pairs();
  pairs_.assign(list.size(), {});
  pair_schedule_.assign(list.size(), {});
  pair_detected_.assign(list.size(), -1);
  pair_looked_.assign(list.size(), -1);
  n_touching_.assign(n, 0);
  pair_wheel_.clear();
  first_pair_of_.assign(n + 1, 0);
  for (std::size_t p = 0; p < list.size(); ++p) {
    pairs_[p].rod[0] = list[p].first;
    pairs_[p].rod[1] = list[p].second;
    ++first_pair_of_[list[p].first + 1];
    ++first_pair_of_[list[p].second + 1];
  }
  std::partial_sum(first_pair_of_.begin(), first_pair_of_.end(), first_pair_of_.begin());
  pairs_of_.resize(2 * list.size());
  std::vector<int> next(first_pair_of_.begin(), first_pair_of_.end() - 1);
  for (int p = 0; p < static_cast<int>(list.size()); ++p) {
    for (int side = 0; side < 2; ++side) pairs_of_[next[pairs_[p].rod[side]]++] = {p, side};
  }
  due_pairs_.resize(list.size());
  std::iota(due_pairs_.begin(), due_pairs_.end(), 0);
}

void ScheduledStepper::detect(const World& world, int p, Tick now) {
  pair_detected_[p] = now;
  PairRecord& pair = pairs_[p];
  const auto& [i, j] = pair.rod;
  const Pose& pose_i = at_tick(world, i, now).pose;
  const Pose& pose_j = at_tick(world, j, now).pose;
  bead_contacts_.clear();
  find_bead_contacts(rules_.species, pose_i.director, rules_.species, pose_j.director,
                     nearest_image(pose_i.position, pose_j.position, rules_.box_side), bead_contacts_);
  for (const BeadContact& beads : bead_contacts_) contacts_.push_back({i, j, beads});
  set_touching(pair, !bead_contacts_.empty());
}

void ScheduledStepper::set_touching(PairRecord& pair, bool touching) {
  if (pair.touching == touching) return;
  pair.touching = touching;
  for (const int i : pair.rod) n_touching_[i] += touching ? 1 : -1;
}

// Beads that overlap but recede are left alone for a while. An impulse on one of the rods can make them approach within
// the very tick, though, so wherever a rod may be hit, its touching pairs take part in that tick's response.
void ScheduledStepper::detect_touching(const World& world, Tick now) {
  may_change_.clear();
  for (const int i : due_rods_) {
    if (rods_[i].changed) may_change_.push_back(i);
  }
  std::size_t n_seen = 0;
  const auto note_contacts = [&] {
    for (; n_seen < contacts_.size(); ++n_seen) {
      may_change_.push_back(contacts_[n_seen].i);
      may_change_.push_back(contacts_[n_seen].j);
    }
  };
  note_contacts();
  for (std::size_t m = 0; m < may_change_.size(); ++m) {
    const int i = may_change_[m];
    if (n_touching_[i] == 0) continue;
    for (int k = first_pair_of_[i]; k < first_pair_of_[i + 1]; ++k) {
      const int p = pairs_of_[k].first;
      if (!pairs_[p].touching || pair_detected_[p] == now) continue;
      due_pairs_.push_back(p);
      detect(world, p, now);
    }
    note_contacts();
  }
}

std::optional<NumericalTrouble> ScheduledStepper::step(World& world, Tick now) {
  const bool first = neighbors_.n_builds() == 0;
  if (first) {
    due_rods_.resize(world.rods.size());
    std::iota(due_rods_.begin(), due_rods_.end(), 0);
  } else {
    take_due(rod_wheel_, rod_schedule_, now, due_rods_);
    take_due(pair_wheel_, pair_schedule_, now, due_pairs_);
  }

  // 1. plates
  bool list_is_due = first;
  if (!due_rods_.empty()) {
    const PlateState plates = world.plates.at(now);
    for (const int i : due_rods_) {
      RodAtTick& rod = at_tick(world, i, now);
      if (!first && neighbors_.slack(i, rod.pose) < kLeastSlack) list_is_due = true;
      if (auto trouble = collide_with_plates(i, rod, world.rods[i], plates, now, rules_, world.counters))
        return trouble;
    }
  }

  // 2. detection
  if (list_is_due) rebuild_pairs(world, now);
  contacts_.clear();
  for (const int p : due_pairs_) detect(world, p, now);
  detect_touching(world, now);
  std::sort(contacts_.begin(), contacts_.end(), [](const PairContact& a, const PairContact& b) {
    return std::tie(a.i, a.j, a.beads.bead_i, a.beads.bead_j) < std::tie(b.i, b.j, b.beads.bead_i, b.beads.bead_j);
  });

  // 3. response
  if (auto trouble = respond(contacts_, rods_, world, now, rules_)) return trouble;

  // 4. storing
  changed_.clear();
  for (const int i : due_rods_) {
    if (rods_[i].changed) changed_.push_back(i);
  }
  for (const PairContact& contact : contacts_) {
    for (const int i : {contact.i, contact.j}) {
      if (rods_[i].changed) changed_.push_back(i);
    }
  }
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const int i : changed_) {
    Flight& flight = world.rods[i];
    const Vec3 precession = flight.precession;
    Vec3 velocity = flight.velocity;
    velocity.z() -= rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt);
    if (auto trouble = store(i, flight, rods_[i], now, rules_)) return trouble;
    strayed_velocity_[i] += (flight.velocity - velocity).norm();
    strayed_precession_[i] += (flight.precession - precession).norm();
  }

  // what was looked at, and what flies differently now, gets new bounds
  for (const int i : due_rods_) {
    if (!rods_[i].changed) schedule_rod(world, i, now);
  }
  for (const int i : changed_) schedule_rod(world, i, now);
  for (const int p : due_pairs_) look_again(world, p, now);
  for (const int i : changed_) {
    if (strayed_velocity_[i] <= allowance_.velocity && strayed_precession_[i] <= allowance_.precession) continue;
    strayed_velocity_[i] = 0;
    strayed_precession_[i] = 0;
    for (int k = first_pair_of_[i]; k < first_pair_of_[i + 1]; ++k) {
      const auto& [p, side] = pairs_of_[k];
      if (pair_schedule_[p].due > now + 1) renew(world, p, side, now);
    }
  }
  return {};
}

}  // namespace shaken
namespace shaken {
std::size_t ScheduledStepper::bytes() const { return 0; }
}
