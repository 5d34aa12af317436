// SPDX-License-Identifier: MIT
#include "sim/stepping/scheduled_stepper.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "sim/core/prefetch.h"

namespace shaken {
namespace {

constexpr double kSkin = 0.4;  ///< of the neighbour list [mm]
/// A rod this close to the end of its slack is placed anew rather than being watched every tick [mm].
constexpr float kLeastSlack = 0.003F;
/// Below this, what is left of a rod's slack is measured again rather than counted down [mm].
constexpr float kLowSlack = 0.05F;
/// Where the hull's bound is shorter than this, the beads' own may be longer: rods interlock.
constexpr float kShortBound = 30;
/// Interlocked rods are looked at again within this time: further ahead their bounds are not worth the work.
constexpr float kBeadHorizon = 200;
/// A bound that allows for straying is good enough if it is this long; a shorter one gives way to the bound for steady
/// flight, unless that is not much longer either. The plates hit a rod about every 50 ticks.
constexpr float kLongBound = 40;
constexpr float kMuchLonger = 1.5;

/// How far a rod may stray before the bounds of its pairs are renewed: from one hit by a neighbour to the next, mostly.
constexpr Allowance kAllowance{1.0F, 25.0F, 1.0F, 12.0F};
/// The limit for its precession, from what it is when the limits are set.
constexpr double kRateFactor = 1.2;
constexpr double kRateMore = 10;  ///< [rad/s]

}  // namespace

ScheduledStepper::ScheduledStepper(const World& world, int n_threads, int grain)
    : rules_(world),
      hull_(world.species),
      lanes_(world.species),
      neighbors_(world.species, world.scene.box_side, kSkin),
      team_(n_threads),
      grain_(grain),
      rods_(world.rods.size()),
      records_(world.rods.size()),
      outlooks_(world.rods.size()),
      rod_wheel_(world.rods.size()),
      poses_(world.rods.size()),
      workers_(n_threads) {}

std::size_t ScheduledStepper::bytes() const {
  std::size_t bytes = neighbors_.bytes() + rod_wheel_.bytes() + pair_wheel_.bytes();
  bytes += heap_bytes(rods_, records_, outlooks_, pairs_, pair_marks_, gained_, lost_);
  bytes += heap_bytes(due_rods_, due_pairs_, changed_, to_pose_, to_look_at_, to_bound_, to_schedule_, next_,
                      may_change_, contacts_, poses_);
  for (const Worker& w : workers_) bytes += heap_bytes(w.bead_contacts, w.contacts, w.turned, w.to_place);
  return bytes;
}

std::optional<NumericalTrouble> ScheduledStepper::step(World& world, Tick now) {
  phase_times.start();
  if (is_new_) {
    due_rods_.resize(world.rods.size());
    std::iota(due_rods_.begin(), due_rods_.end(), 0);
    for (const int i : due_rods_) set_limits(records_[i], world.rods[i]);
  } else {
    rod_wheel_.pop(now, due_rods_);
  }
  phase_times.lap(Phase::kSchedule);

  // 1. plates
  if (auto trouble = collide_with_plates_due(world, now)) return trouble;
  phase_times.lap(Phase::kPlates);

  // 2. detection
  list_pairs(world, now);
  phase_times.lap(Phase::kNeighbors);
  detect_due(world, now);
  detect_touching(world, now);
  std::sort(contacts_.begin(), contacts_.end(), [](const PairContact& a, const PairContact& b) {
    return std::tie(a.i, a.j, a.beads.bead_i, a.beads.bead_j) < std::tie(b.i, b.j, b.beads.bead_i, b.beads.bead_j);
  });
  phase_times.lap(Phase::kDetection);

  // 3. response
  if (auto trouble = respond(contacts_, rods_, world, now, rules_)) return trouble;
  phase_times.lap(Phase::kResponse);

  // 4. storing
  list_changed(now);
  if (auto trouble = store_changed(world, now)) return trouble;
  phase_times.lap(Phase::kStoring);

  // what was looked at, and what flies differently now, gets new bounds
  schedule_rods(world, now);
  schedule_pairs(world, now);
  return {};
}

// ---- phases

void ScheduledStepper::list_to_pose(int i, Tick now) {
  if (records_[i].posed_at == stamp(now)) return;
  records_[i].posed_at = stamp(now);
  to_pose_.push_back(i);
}

void ScheduledStepper::pose(const World& world, Tick now) {
  team_.run(static_cast<int>(to_pose_.size()), grain_, [&](int begin, int end, int) {
    visit_ahead(
        to_pose_, begin, end,
        [&](int i) {
          prefetch(world.rods[i]);
          prefetch(rods_[i]);
        },
        [&](int i) { rods_[i] = rod_at_tick(world.rods[i], now, rules_); });
  });
}

std::optional<NumericalTrouble> ScheduledStepper::collide_with_plates_due(World& world, Tick now) {
  if (due_rods_.empty()) return {};
  const PlateState plates = world.plates.at(now);
  team_.run(static_cast<int>(due_rods_.size()), grain_, [&](int begin, int end, int w) {
    Worker& worker = workers_[w];
    const auto ask = [&](int i) {
      prefetch(world.rods[i]);
      prefetch(rods_[i]);
      prefetch(records_[i]);
    };
    visit_ahead(due_rods_, begin, end, ask, [&](int i) {
      RodRecord& record = records_[i];
      rods_[i] = rod_at_tick(world.rods[i], now, rules_);
      record.posed_at = stamp(now);
      record.listed_at = stamp(now);
      if (slack_left(i, now) < kLeastSlack) {
        measure_slack(i, now);
        if (record.slack < kLeastSlack) worker.to_place.push_back(i);
      }
      auto trouble = collide_with_plates(i, rods_[i], world.rods[i], plates, now, rules_, worker.counters);
      if (trouble) worker.note(std::move(*trouble));
    });
  });
  for (Worker& worker : workers_) {
    world.counters.add(worker.counters);
    worker.counters = {};
  }
  return first_trouble();
}

void ScheduledStepper::Worker::note(NumericalTrouble met) {
  if (!trouble || met.rods < trouble->rods) trouble = std::move(met);
}

std::optional<NumericalTrouble> ScheduledStepper::first_trouble() const {
  std::optional<NumericalTrouble> first;
  for (const Worker& worker : workers_) {
    if (worker.trouble && (!first || worker.trouble->rods < first->rods)) first = worker.trouble;
  }
  return first;
}

void ScheduledStepper::list_pairs(const World& world, Tick now) {
  gained_.clear();
  if (is_new_) {
    for (std::size_t i = 0; i < world.rods.size(); ++i) poses_[i] = rods_[i].pose;
    neighbors_.build(poses_);
    for (int i = 0; i < static_cast<int>(world.rods.size()); ++i) measure_slack(i, now);
    gained_.resize(neighbors_.pairs().size());
    std::iota(gained_.begin(), gained_.end(), 0);
    is_new_ = false;
  }
  lost_.clear();
  for (Worker& worker : workers_) {
    for (const int i : worker.to_place) {
      neighbors_.place(i, rods_[i].pose, gained_, lost_);
      measure_slack(i, now);
    }
    worker.to_place.clear();
  }
  pairs_.resize(neighbors_.pairs().size());
  pair_marks_.resize(pairs_.size());
  pair_wheel_.make_room(pairs_.size());
  for (const int p : lost_) {  // certainly not touching
    if (pairs_[p].rod[0] >= 0) mark_steady(p, false);
    pairs_[p] = {};
    pair_wheel_.remove(p);
  }
  pair_wheel_.pop(now, due_pairs_);
  for (const int p : gained_) {
    const NeighborList::Pair& pair = neighbors_.pairs()[p];
    if (pair.i < 0 || pairs_[p].rod[0] >= 0) continue;  // lost again, or met twice
    pairs_[p].rod[0] = pair.i;
    pairs_[p].rod[1] = pair.j;
    due_pairs_.push_back(p);
  }
}

bool ScheduledStepper::detect(int p, Worker& worker) {
  const PairRecord& pair = pairs_[p];
  const auto& [i, j] = pair.rod;
  const Pose& pose_i = rods_[i].pose;
  const Pose& pose_j = rods_[j].pose;
  const Vec3 D = nearest_image(pose_i.position, pose_j.position, rules_.box_side);
  // most pairs are still apart in the direction in which they were
  constexpr double kMargin = 1e-5;
  const Vec3 d(pair.direction[0], pair.direction[1], pair.direction[2]);
  if (hull_gap(hull_, std::abs(pose_i.director.dot(d)), hull_, std::abs(pose_j.director.dot(d)), D.dot(d)) > kMargin)
    return false;
  const BeadRange beads_i = beads_may_overlap(lanes_, pose_i.director, lanes_, pose_j.director, D);
  if (beads_i.empty()) return false;
  worker.bead_contacts.clear();
  find_bead_contacts(rules_.species, pose_i.director, rules_.species, pose_j.director, D, beads_i,
                     worker.bead_contacts);
  for (const BeadContact& beads : worker.bead_contacts) worker.contacts.push_back({i, j, beads});
  return !worker.bead_contacts.empty();
}

void ScheduledStepper::detect_due(const World& world, Tick now) {
  contacts_.clear();
  if (due_pairs_.empty()) return;
  to_pose_.clear();
  visit_ahead(
      due_pairs_, 0, static_cast<int>(due_pairs_.size()), [&](int p) { prefetch(pairs_[p]); },
      [&](int p) {
        for (const int i : pairs_[p].rod) list_to_pose(i, now);
      });
  pose(world, now);
  team_.run(static_cast<int>(due_pairs_.size()), grain_, [&](int begin, int end, int w) {
    Worker& worker = workers_[w];
    for (int k = begin; k < end; ++k) {
      const int p = due_pairs_[k];
      pairs_[p].detected_at = stamp(now);
      if (detect(p, worker) != pairs_[p].touching) worker.turned.push_back(p);
    }
  });
  for (Worker& worker : workers_) {
    contacts_.insert(contacts_.end(), worker.contacts.begin(), worker.contacts.end());
    worker.contacts.clear();
    for (const int p : worker.turned) turn_touching(p);
    worker.turned.clear();
  }
}

void ScheduledStepper::mark_steady(int p, bool steady) {
  const bool was = pair_marks_[p] & kSteady;
  pair_marks_[p] = steady ? kSteady : 0;
  if (steady == was) return;
  for (const int i : pairs_[p].rod)
    records_[i].n_steady = static_cast<std::int16_t>(records_[i].n_steady + (steady ? 1 : -1));
}

void ScheduledStepper::turn_touching(int p) {
  PairRecord& pair = pairs_[p];
  pair.touching = !pair.touching;
  for (const int i : pair.rod) records_[i].n_touching += pair.touching ? 1 : -1;
}

// Beads that overlap but recede are left alone for a while. An impulse on one of the rods can make them approach within
// the very tick, though, so wherever a rod may be hit, its touching pairs take part in that tick's response.
void ScheduledStepper::detect_touching(const World& world, Tick now) {
  may_change_.clear();
  for (const int i : due_rods_) {
    if (rods_[i].changed && records_[i].n_touching > 0) may_change_.push_back(i);
  }
  std::size_t n_seen = 0;
  const auto note_contacts = [&] {
    for (; n_seen < contacts_.size(); ++n_seen) {
      for (const int i : {contacts_[n_seen].i, contacts_[n_seen].j}) {
        if (records_[i].n_touching > 1) may_change_.push_back(i);  // in more than this pair
      }
    }
  };
  note_contacts();
  Worker& worker = workers_.front();
  for (std::size_t m = 0; m < may_change_.size(); ++m) {
    const int i = may_change_[m];
    for (const int p : neighbors_.pairs_of(i)) {
      if (!pairs_[p].touching || pairs_[p].detected_at == stamp(now)) continue;
      due_pairs_.push_back(p);
      pairs_[p].detected_at = stamp(now);
      to_pose_.clear();
      for (const int rod : pairs_[p].rod) list_to_pose(rod, now);
      pose(world, now);
      if (!detect(p, worker)) turn_touching(p);
      contacts_.insert(contacts_.end(), worker.contacts.begin(), worker.contacts.end());
      worker.contacts.clear();
    }
    note_contacts();
  }
}

void ScheduledStepper::list_changed(Tick now) {
  changed_.clear();
  to_schedule_ = due_rods_;
  for (const int i : due_rods_) {
    if (rods_[i].changed) changed_.push_back(i);
  }
  for (const PairContact& contact : contacts_) {
    for (const int i : {contact.i, contact.j}) {
      if (!rods_[i].changed || records_[i].listed_at == stamp(now)) continue;
      records_[i].listed_at = stamp(now);
      changed_.push_back(i);
      to_schedule_.push_back(i);
    }
  }
}

std::optional<NumericalTrouble> ScheduledStepper::store_changed(World& world, Tick now) {
  team_.run(static_cast<int>(changed_.size()), grain_, [&](int begin, int end, int w) {
    for (int k = begin; k < end; ++k) {
      const int i = changed_[k];
      Flight& flight = world.rods[i];
      RodRecord& record = records_[i];
      const Vec3 precession = flight.precession;
      Vec3 velocity = flight.velocity;
      velocity.z() -= rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt);
      if (auto trouble = store(i, flight, rods_[i], now, rules_)) workers_[w].note(std::move(*trouble));
      add_vector(record.strayed_velocity, flight.velocity - velocity);
      add_vector(record.strayed_turning, (flight.precession - precession).cross(flight.director));
      record.strayed = !within_limits(record, flight);
      if (record.strayed) set_limits(record, flight);
    }
  });
  return first_trouble();
}

// ---- a rod's limits

bool ScheduledStepper::within_limits(const RodRecord& record, const Flight& flight) const {
  const auto within = [](const float* strayed, float across, float along_z) {
    constexpr float kKept = 0.998F;  // for rounding: what strayed is a sum of many floats
    return strayed[0] * strayed[0] + strayed[1] * strayed[1] <= kKept * across * across &&
           std::abs(strayed[2]) <= kKept * along_z;
  };
  return flight.rate <= static_cast<double>(record.rate_limit) &&
         within(record.strayed_velocity, kAllowance.velocity_xy, kAllowance.velocity_z) &&
         within(record.strayed_turning, kAllowance.turning_xy, kAllowance.turning_z);
}

void ScheduledStepper::set_limits(RodRecord& record, const Flight& flight) {
  std::fill_n(record.strayed_velocity, 3, 0.0F);
  std::fill_n(record.strayed_turning, 3, 0.0F);
  record.rate_limit = static_cast<float>(kRateFactor * flight.rate + kRateMore);
}

Outlook ScheduledStepper::outlook(const World& world, int i, Tick now) const {
  const Flight& flight = world.rods[i];
  const RodRecord& record = records_[i];
  const Vec3& director = rods_[i].pose.director;
  Vec3 velocity = flight.velocity;
  velocity.z() -= rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt);
  const Vec3 turning = flight.precession.cross(director);
  Outlook outlook;
  set_vector(outlook.director, director);
  set_vector(outlook.velocity, velocity);
  set_vector(outlook.turning, turning);
  outlook.half_rate2 = static_cast<float>(0.5 * flight.rate * flight.rate);
  for (int c = 0; c < 3; ++c) {
    outlook.velocity_center[c] = outlook.velocity[c] - record.strayed_velocity[c];
    outlook.turning_center[c] = outlook.turning[c] - record.strayed_turning[c];
  }
  outlook.limit_half_rate2 = 0.5F * record.rate_limit * record.rate_limit;
  return outlook;
}

// ---- schedules

float ScheduledStepper::slack_left(int i, Tick now) const {
  const RodRecord& record = records_[i];
  const Stamp ticks = stamp(now) - record.slack_at;
  return record.slack - record.slack_speed * (static_cast<float>(ticks) * static_cast<float>(rules_.dt));
}

void ScheduledStepper::measure_slack(int i, Tick now) {
  // a little is kept for the rounding of floats
  records_[i].slack = static_cast<float>(neighbors_.slack(i, rods_[i].pose)) - 1e-4F;
  records_[i].slack_at = stamp(now);
}

void ScheduledStepper::schedule_rods(const World& world, Tick now) {
  const int n = static_cast<int>(to_schedule_.size());
  next_.resize(n);
  team_.run(n, grain_, [&](int begin, int end, int w) {
    PlateLanes& lanes = workers_[w].plate_lanes;
    Tick off_plates[kLanes];
    for (int at = begin; at < end; at += kLanes) {
      const int n_lanes = std::min(kLanes, end - at);
      for (int lane = 0; lane < n_lanes; ++lane) {
        const int i = to_schedule_[at + lane];
        const Flight& flight = world.rods[i];
        const Pose& pose = rods_[i].pose;
        lanes.z[lane] = static_cast<float>(pose.position.z());
        lanes.velocity[lane] = static_cast<float>(
            flight.velocity.z() - rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt));
        lanes.n_z[lane] = static_cast<float>(pose.director.z());
        lanes.n_z_rate[lane] =
            static_cast<float>(flight.precession.x() * pose.director.y() - flight.precession.y() * pose.director.x());
        lanes.rate2[lane] = static_cast<float>(flight.rate * flight.rate);
      }
      plate_safe_ticks(rules_.species, world.plates, lanes, n_lanes, rules_.gravity, rules_.dt, now,
                       TimingWheel::horizon() - 1, off_plates);
      for (int lane = 0; lane < n_lanes; ++lane) {
        const int i = to_schedule_[at + lane];
        next_[at + lane] = now + 1 + std::min(off_plates[lane], listed_ticks(world, i, now));
      }
    }
  });
  for (int k = 0; k < n; ++k) rod_wheel_.set(to_schedule_[k], next_[k]);
  phase_times.lap(Phase::kBounds);
}

/// Ticks for which the neighbour list certainly covers rod i.
Tick ScheduledStepper::listed_ticks(const World& world, int i, Tick now) {
  const Flight& flight = world.rods[i];
  RodRecord& record = records_[i];
  record.slack = slack_left(i, now);
  record.slack_at = stamp(now);
  if (record.slack < kLowSlack) measure_slack(i, now);
  // The segment turns at (p_z - n_z p.n) / |n_xy|^2, with p the precession and p.n a constant; |n_xy| changes by at
  // most |p| per time, so it keeps nine tenths for a while.
  const Vec3& n = rods_[i].pose.director;
  const Vec3& v = flight.velocity;
  const Vec3& p = flight.precession;
  const double flat2 = n.x() * n.x() + n.y() * n.y();
  const double turn = (std::abs(p.z()) + std::abs(p.dot(n))) / (0.81 * flat2);
  const double speed = std::sqrt(v.x() * v.x() + v.y() * v.y()) + rules_.species.half_length * turn;
  record.slack_speed = static_cast<float>(speed);
  const double time =
      std::min(std::max(static_cast<double>(record.slack), 0.0) / speed, 0.1 * std::sqrt(flat2) / flight.rate);
  const double horizon = static_cast<double>(TimingWheel::horizon() - 1);
  // a rod at rest has all the time there is
  return static_cast<Tick>(time < horizon * rules_.dt ? time / rules_.dt * (1.0 - 1e-12) : horizon);
}

void ScheduledStepper::schedule_pairs(const World& world, Tick now) {
  to_bound_.clear();
  const auto list = [&](int p) {
    if (pair_marks_[p] & kListed) return;
    pair_marks_[p] |= kListed;
    to_bound_.push_back(p);
  };
  for (const int p : due_pairs_) list(p);
  visit_ahead(
      changed_, 0, static_cast<int>(changed_.size()), [&](int i) { __builtin_prefetch(neighbors_.pairs_of(i).data()); },
      [&](int i) {
        const bool strayed = records_[i].strayed;
        if (!strayed && records_[i].n_steady == 0) return;
        for (const int p : neighbors_.pairs_of(i)) {
          if (strayed || (pair_marks_[p] & kSteady)) list(p);
        }
      });
  if (to_bound_.empty()) return;

  to_look_at_.clear();
  visit_ahead(
      to_bound_, 0, static_cast<int>(to_bound_.size()), [&](int p) { prefetch(pairs_[p]); },
      [&](int p) {
        for (const int i : pairs_[p].rod) {
          if (records_[i].outlook_at == stamp(now)) continue;
          records_[i].outlook_at = stamp(now);
          to_look_at_.push_back(i);
        }
      });
  team_.run(static_cast<int>(to_look_at_.size()), grain_, [&](int begin, int end, int) {
    const auto ask = [&](int i) {
      prefetch(world.rods[i]);
      prefetch(rods_[i]);
      prefetch(records_[i]);
      prefetch(outlooks_[i]);
    };
    visit_ahead(to_look_at_, begin, end, ask, [&](int i) {
      if (records_[i].posed_at != stamp(now)) {
        records_[i].posed_at = stamp(now);
        rods_[i] = rod_at_tick(world.rods[i], now, rules_);
      }
      outlooks_[i] = outlook(world, i, now);
    });
  });
  next_.resize(to_bound_.size());
  next_steady_.resize(to_bound_.size());
  team_.run(static_cast<int>(to_bound_.size()), grain_, [&](int begin, int end, int w) {
    for (int at = begin; at < end; at += kLanes) bound_pairs(at, std::min(kLanes, end - at), now, workers_[w]);
  });
  phase_times.lap(Phase::kBounds);
  for (std::size_t k = 0; k < to_bound_.size(); ++k) {
    mark_steady(to_bound_[k], next_steady_[k]);
    pair_wheel_.set(to_bound_[k], next_[k]);
  }
  phase_times.lap(Phase::kSchedule);
}

void ScheduledStepper::bound_pairs(int first, int n, Tick now, Worker& worker) {
  PairLanes& lanes = worker.pair_lanes;
  HullSafeTimes hull;
  Vec3 D[kLanes];
  for (int lane = 0; lane < n; ++lane) {
    const auto& [i, j] = pairs_[to_bound_[first + lane]].rod;
    D[lane] = nearest_image(rods_[i].pose.position, rods_[j].pose.position, rules_.box_side);
    lanes.set(lane, D[lane], outlooks_[i], outlooks_[j]);
  }
  const auto horizon = static_cast<float>(static_cast<double>(TimingWheel::horizon() - 1) * rules_.dt);
  hull_safe_times(hull_, hull_, lanes, kAllowance, horizon, hull);

  const auto per_dt = static_cast<float>((1.0 - 1e-5) / rules_.dt);
  for (int lane = 0; lane < n; ++lane) {
    const int p = to_bound_[first + lane];
    PairRecord& pair = pairs_[p];
    for (int c = 0; c < 3; ++c) pair.direction[c] = hull.direction[c][lane];
    float steady = hull.steady[lane] * per_dt;
    float straying = hull.straying[lane] * per_dt;
    if (steady < kShortBound && straying < kShortBound) {
      const auto& [i, j] = pair.rod;
      const SafeTime beads = bead_safe_time(lanes_, outlooks_[i], lanes_, outlooks_[j], D[lane], kAllowance,
                                            kBeadHorizon * static_cast<float>(rules_.dt));
      steady = std::max(steady, beads.steady * per_dt);
      straying = std::max(straying, beads.straying * per_dt);
    }
    const bool is_steady = straying < kLongBound && straying * kMuchLonger < steady;
    next_steady_[first + lane] = is_steady;
    next_[first + lane] = now + 1 + static_cast<Tick>(is_steady ? steady : straying);
  }
}

}  // namespace shaken
