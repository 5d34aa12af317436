// SPDX-License-Identifier: MIT
#include "sim/stepping/scheduled_stepper.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sim/contact/image_safe_time.h"
#include "sim/core/prefetch.h"
#include "sim/motion/side_walls.h"

namespace shaken {
namespace {

constexpr double kSkin = 0.4;  ///< of the neighbour list [mm]
/// A rod this close to the end of its slack is placed anew rather than being watched every tick [mm].
constexpr float kLeastSlack = 0.003F;
/// Below this, what is left of a rod's slack is measured again rather than counted down [mm].
constexpr float kLowSlack = 0.05F;
/// Where the hull's bound is shorter than this, the beads' own may be longer: rods interlock [ticks].
constexpr float kShortBound = 30;
/// Interlocked rods are looked at again within this time: further ahead their bounds are not worth the work [ticks].
constexpr float kBeadHorizon = 200;
/// A bound that allows for straying is good enough if it is this long [ticks]; a shorter one gives way to the bound for
/// steady flight, unless that is not much longer either. The plates hit a rod about every 50 ticks.
constexpr float kLongBound = 40;
constexpr float kMuchLonger = 1.5;

/// How far a rod may stray before the bounds of its pairs are renewed: from one hit by a neighbour to the next, mostly.
constexpr Allowance kAllowance{1.0F, 25.0F, 1.0F, 12.0F};
/// The limit for its precession, from what it is when the limits are set.
constexpr double kRateFactor = 1.2;
constexpr double kRateMore = 10;  ///< [rad/s]

}  // namespace

ScheduledStepper::ScheduledStepper(const World& world, int n_threads, int grain, const Kernels& kernels)
    : rules_(world),
      kernels_(kernels),
      neighbors_(world.species, world.kinds, world.scene.box_side, kSkin),
      team_(n_threads),
      grain_(grain),
      rods_(world.rods.size()),
      records_(world.rods.size()),
      marks_(world.rods.size()),
      outlooks_(world.rods.size()),
      rod_owners_(world.rods.size()),
      rod_wheel_(world.rods.size()),
      workers_(n_threads) {
  for (const RodKind& kind : rules_.kinds) {
    hulls_.emplace_back(kind.species);
    lanes_.emplace_back(kind.species);
    reach_.push_back(kind.species.reach());
  }
  if (world.scene.impacts == ImpactTime::kAtInstant) found_.resize(world.rods.size());
  // rods are numbered along the rows that they start in, so these are bands of the plane
  const std::size_t n = world.rods.size();
  for (std::size_t i = 0; i < n; ++i) rod_owners_[i] = static_cast<std::uint8_t>(i * workers_.size() / n);
}

std::size_t ScheduledStepper::bytes() const {
  std::size_t bytes = neighbors_.bytes() + rod_wheel_.bytes() + pair_wheel_.bytes();
  bytes += heap_bytes(rods_, found_, records_, marks_, outlooks_, rod_owners_);
  bytes += heap_bytes(pair_rods_, directions_, detected_at_, pair_marks_, pair_owners_);
  bytes += heap_bytes(due_rods_, due_pairs_, contacts_, changed_, to_pose_, to_look_at_, to_schedule_, to_bound_,
                      may_change_, gained_, lost_);
  bytes += heap_bytes(workers_);
  for (const Worker& w : workers_)
    bytes +=
        heap_bytes(w.own, w.next, w.next_steady, w.bead_contacts, w.contacts, w.turned, w.hit, w.strayed, w.to_place);
  return bytes;
}

template <class Visit>
void ScheduledStepper::share(const std::vector<int>& list, const std::vector<std::uint8_t>& owners,
                             const Visit& visit) {
  if (team_.size() == 1 || static_cast<int>(list.size()) < grain_ * team_.size()) {
    for (Worker& worker : workers_) worker.mine = {};
    workers_[0].mine = list;
    visit(workers_[0]);
    return;
  }
  team_.run([&](int w) {
    Worker& worker = workers_[w];
    // without a branch, which would be mispredicted every other time
    worker.own.resize(list.size());
    std::size_t n = 0;
    for (const int item : list) {
      worker.own[n] = item;
      n += owners[item] == w;
    }
    worker.mine = std::span(worker.own).first(n);
    visit(worker);
  });
}

template <class Group>
void ScheduledStepper::sort_by(const Group& group, std::vector<int>& list) const {
  if (rules_.kinds.size() == 1) return;
  std::stable_sort(list.begin(), list.end(), [&](int a, int b) { return group(a) < group(b); });
}

template <class Group, class Visit>
void ScheduledStepper::in_lanes(const Group& group, std::span<const int> list, const Visit& visit) const {
  const bool mixed = rules_.kinds.size() > 1;
  while (!list.empty()) {
    std::size_t n = std::min<std::size_t>(kLanes, list.size());
    if (mixed) {
      const int first = group(list.front());
      std::size_t alike = 1;
      while (alike < n && group(list[alike]) == first) ++alike;
      n = alike;
    }
    visit(list.first(n));
    list = list.subspan(n);
  }
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

  // 1. surfaces
  if (auto trouble = meet_surfaces_due(world, now)) return trouble;
  phase_times.lap(Phase::kPlates);

  // 2. detection
  list_pairs(world, now);
  phase_times.lap(Phase::kNeighbors);
  detect_due(world, now);
  detect_touching(world, now);
  sort_contacts(contacts_, rods_, rules_);
  phase_times.lap(Phase::kDetection);

  // 3. response
  if (auto trouble = kernels_.respond(contacts_, rods_, world, now, rules_)) return trouble;
  phase_times.lap(Phase::kResponse);

  // 4. storing
  to_schedule_ = due_rods_;
  for (const PairContact& contact : contacts_) {
    for (const int i : {contact.i, contact.j}) {
      if (!rods_[i].changed) continue;
      list_changed(i, now);
      if (marks_[i].listed_at == now) continue;
      marks_[i].listed_at = now;
      to_schedule_.push_back(i);
    }
  }
  if (auto trouble = store_changed(world, now)) return trouble;
  phase_times.lap(Phase::kStoring);

  // what was looked at, and what flies differently now, gets new bounds
  schedule_rods(world, now);
  schedule_pairs(world, now);
  return {};
}

// ---- phases

void ScheduledStepper::list_to_pose(int i, Tick now) {
  if (marks_[i].posed_at == now) return;
  marks_[i].posed_at = now;
  to_pose_.push_back(i);
}

void ScheduledStepper::pose(const World& world, Tick now) {
  const auto ask = [&](int i) {
    prefetch(world.rods[i]);
    prefetch(rods_[i]);
  };
  share(to_pose_, rod_owners_, [&](Worker& worker) {
    visit_ahead(worker.mine, ask, [&](int i) {
      rods_[i] = rod_at_tick(world.rods[i], now, rules_);
      if (!found_.empty()) found_[i] = rods_[i].pose;
    });
  });
}

std::optional<NumericalTrouble> ScheduledStepper::meet_surfaces_due(World& world, Tick now) {
  changed_.clear();
  if (due_rods_.empty()) return {};
  for (const int i : due_rods_) marks_[i].posed_at = marks_[i].listed_at = now;
  const PlateState plates = world.plates.at(now);
  const auto ask = [&](int i) {
    prefetch(world.rods[i]);
    prefetch(rods_[i]);
    prefetch(records_[i]);
  };
  share(due_rods_, rod_owners_, [&](Worker& worker) {
    visit_ahead(worker.mine, ask, [&](int i) {
      rods_[i] = rod_at_tick(world.rods[i], now, rules_);
      if (!found_.empty()) found_[i] = rods_[i].pose;
      if (slack_left(i, now) < kLeastSlack) {
        measure_slack(i, now);
        if (records_[i].slack < kLeastSlack) worker.to_place.push_back(i);
      }
      auto trouble = kernels_.meet_surfaces(i, rods_[i], world.rods[i], plates, now, rules_, worker.counters);
      if (trouble) worker.note(std::move(*trouble));
      if (rods_[i].changed) worker.hit.push_back(i);
    });
  });
  for (Worker& worker : workers_) {
    world.counters.add(worker.counters);
    worker.counters = {};
    for (const int i : worker.hit) list_changed(i, now);
    worker.hit.clear();
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
    std::vector<Pose> poses(world.rods.size());
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = found(static_cast<int>(i));
    neighbors_.build(poses);
    for (int i = 0; i < static_cast<int>(world.rods.size()); ++i) measure_slack(i, now);
    gained_.resize(neighbors_.pairs().size());
    std::iota(gained_.begin(), gained_.end(), 0);
    is_new_ = false;
  }
  lost_.clear();
  for (Worker& worker : workers_) {
    for (const int i : worker.to_place) {
      neighbors_.place(i, found(i), gained_, lost_);
      measure_slack(i, now);
    }
    worker.to_place.clear();
  }
  const std::size_t n_pairs = neighbors_.pairs().size();
  pair_rods_.resize(n_pairs, kUnused);
  directions_.resize(n_pairs);
  detected_at_.resize(n_pairs, kNever);
  pair_marks_.resize(n_pairs);
  pair_owners_.resize(n_pairs);
  pair_wheel_.make_room(n_pairs);
  for (const int p : lost_) {
    if (pair_rods_[p] != kUnused) {
      mark_steady(p, false);
      if (pair_marks_[p] & kTouching) turn_touching(p);  // it was at its last look; by now it certainly is not
    }
    pair_rods_[p] = kUnused;
    pair_wheel_.remove(p);
  }
  pair_wheel_.pop(now, due_pairs_);
  for (const int p : gained_) {
    const NeighborList::Pair& pair = neighbors_.pairs()[p];
    if (pair.i < 0 || pair_rods_[p] != kUnused) continue;  // lost again, or met twice
    pair_rods_[p] = {pair.i, pair.j};
    pair_owners_[p] = rod_owners_[pair.i];
    directions_[p] = {};
    due_pairs_.push_back(p);
  }
}

bool ScheduledStepper::detect(int p, Worker& worker) {
  const auto& [i, j] = pair_rods_[p];
  const Pose& pose_i = found(i);
  const Pose& pose_j = found(j);
  const std::uint8_t kind_i = rules_.rod_kinds[i];
  const std::uint8_t kind_j = rules_.rod_kinds[j];
  const Vec3 D = nearest_image(pose_i.position, pose_j.position, rules_.box_side);
  // most pairs are still apart in the direction in which they were
  constexpr double kMargin = 1e-5;
  const Vec3 d(directions_[p][0], directions_[p][1], directions_[p][2]);
  if (hull_gap(hulls_[kind_i], std::abs(pose_i.director.dot(d)), hulls_[kind_j], std::abs(pose_j.director.dot(d)),
               D.dot(d)) > kMargin)
    return false;
  const BeadRange beads_i = beads_may_overlap(lanes_[kind_i], pose_i.director, lanes_[kind_j], pose_j.director, D);
  if (beads_i.empty()) return false;
  worker.bead_contacts.clear();
  find_bead_contacts(rules_.kinds[kind_i].species, pose_i.director, rules_.kinds[kind_j].species, pose_j.director, D,
                     beads_i, worker.bead_contacts);
  for (const BeadContact& beads : worker.bead_contacts) worker.contacts.push_back({i, j, beads});
  return !worker.bead_contacts.empty();
}

void ScheduledStepper::detect_due(const World& world, Tick now) {
  contacts_.clear();
  if (due_pairs_.empty()) return;
  to_pose_.clear();
  for (const int p : due_pairs_) {
    detected_at_[p] = now;
    for (const int i : pair_rods_[p]) list_to_pose(i, now);
  }
  pose(world, now);
  share(due_pairs_, pair_owners_, [&](Worker& worker) {
    for (const int p : worker.mine) {
      if (detect(p, worker) != static_cast<bool>(pair_marks_[p] & kTouching)) worker.turned.push_back(p);
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
  if (static_cast<bool>(pair_marks_[p] & kSteady) == steady) return;
  pair_marks_[p] ^= kSteady;
  for (const int i : pair_rods_[p])
    marks_[i].n_steady = static_cast<std::int16_t>(marks_[i].n_steady + (steady ? 1 : -1));
}

void ScheduledStepper::turn_touching(int p) {
  pair_marks_[p] ^= kTouching;
  const int more = pair_marks_[p] & kTouching ? 1 : -1;
  for (const int i : pair_rods_[p]) marks_[i].n_touching = static_cast<std::int16_t>(marks_[i].n_touching + more);
}

// Beads that overlap but recede are left alone for a while. An impulse on one of the rods can make them approach within
// the very tick, though, so wherever a rod may be hit, its touching pairs take part in that tick's response.
void ScheduledStepper::detect_touching(const World& world, Tick now) {
  may_change_.clear();
  for (const int i : changed_) {
    if (marks_[i].n_touching > 0) may_change_.push_back(i);
  }
  std::size_t n_seen = 0;
  const auto note_contacts = [&] {
    for (; n_seen < contacts_.size(); ++n_seen) {
      for (const int i : {contacts_[n_seen].i, contacts_[n_seen].j}) {
        if (marks_[i].n_touching > 1) may_change_.push_back(i);  // in more than this pair
      }
    }
  };
  note_contacts();
  Worker& worker = workers_.front();
  for (std::size_t m = 0; m < may_change_.size(); ++m) {
    const int i = may_change_[m];
    for (const int p : neighbors_.pairs_of(i)) {
      if (!(pair_marks_[p] & kTouching) || detected_at_[p] == now) continue;
      due_pairs_.push_back(p);
      detected_at_[p] = now;
      to_pose_.clear();
      for (const int rod : pair_rods_[p]) list_to_pose(rod, now);
      pose(world, now);
      if (!detect(p, worker)) turn_touching(p);
      contacts_.insert(contacts_.end(), worker.contacts.begin(), worker.contacts.end());
      worker.contacts.clear();
    }
    note_contacts();
  }
}

void ScheduledStepper::list_changed(int i, Tick now) {
  if (marks_[i].changed_at == now) return;
  marks_[i].changed_at = now;
  changed_.push_back(i);
}

std::optional<NumericalTrouble> ScheduledStepper::store_changed(World& world, Tick now) {
  share(changed_, rod_owners_, [&](Worker& worker) {
    for (const int i : worker.mine) {
      if (auto trouble = check_motion(i, rods_[i], now, rules_)) worker.note(std::move(*trouble));
    }
  });
  if (auto trouble = first_trouble()) return trouble;
  share(changed_, rod_owners_, [&](Worker& worker) {
    for (const int i : worker.mine) {
      Flight& flight = world.rods[i];
      RodRecord& record = records_[i];
      const Vec3 precession = flight.precession;
      Vec3 velocity = flight.velocity;
      velocity.z() -= rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt);
      store(i, flight, rods_[i], now, rules_);
      add_vector(record.strayed_velocity, flight.velocity - velocity);
      const Vec3 turned = flight.precession - precession;
      add_vector(record.strayed_turning, turned.cross(flight.director));
      if (rods_[i].displaced) {
        // hit a little before now, where the director was not yet quite what it is; and displaced against the path that
        // the list of neighbours knows of
        record.blur += static_cast<float>(turned.norm() * static_cast<double>(record.rate_limit) * rules_.dt);
        measure_slack(i, now);
      }
      // hit once, at its instant, it has followed one path within its limits; hit more often, it is where none may have
      // led it
      if (!(rods_[i].displaced && rods_[i].hit_again) && within_limits(record, flight)) continue;
      set_limits(record, flight);
      worker.strayed.push_back(i);
    }
  });
  return {};
}

// ---- a rod's limits

bool ScheduledStepper::within_limits(const RodRecord& record, const Flight& flight) const {
  const auto within = [](const float* strayed, float across, float along_z) {
    constexpr float kKept = 0.998F;  // for rounding: what strayed is a sum of many floats
    return across > 0 && along_z > 0 && strayed[0] * strayed[0] + strayed[1] * strayed[1] <= kKept * across * across &&
           std::abs(strayed[2]) <= kKept * along_z;
  };
  return flight.rate <= static_cast<double>(record.rate_limit) &&
         within(record.strayed_velocity, kAllowance.velocity_xy, kAllowance.velocity_z) &&
         within(record.strayed_turning, kAllowance.turning_xy - record.blur, kAllowance.turning_z - record.blur);
}

void ScheduledStepper::set_limits(RodRecord& record, const Flight& flight) {
  std::fill_n(record.strayed_velocity, 3, 0.0F);
  std::fill_n(record.strayed_turning, 3, 0.0F);
  record.blur = 0;
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
  const Tick ticks = now - record.slack_at;
  return record.slack - record.slack_speed * (static_cast<float>(ticks) * static_cast<float>(rules_.dt));
}

void ScheduledStepper::measure_slack(int i, Tick now) {
  // a little is kept for the rounding of floats
  records_[i].slack = static_cast<float>(neighbors_.slack(i, rods_[i].pose)) - 1e-4F;
  records_[i].slack_at = now;
}

void ScheduledStepper::schedule_rods(const World& world, Tick now) {
  const auto group = [this](int i) { return rod_group(i); };
  sort_by(group, to_schedule_);
  share(to_schedule_, rod_owners_, [&](Worker& worker) {
    worker.next.clear();
    PlateLanes& lanes = worker.plate_lanes;
    Tick off_plates[kLanes];
    in_lanes(group, worker.mine, [&](std::span<const int> rods) {
      for (std::size_t lane = 0; lane < rods.size(); ++lane) {
        const Flight& flight = world.rods[rods[lane]];
        const Pose& pose = rods_[rods[lane]].pose;
        lanes.z[lane] = static_cast<float>(pose.position.z());
        lanes.velocity[lane] = static_cast<float>(
            flight.velocity.z() - rules_.gravity * (static_cast<double>(now - flight.since) * rules_.dt));
        lanes.n_z[lane] = static_cast<float>(pose.director.z());
        lanes.n_z_rate[lane] =
            static_cast<float>(flight.precession.x() * pose.director.y() - flight.precession.y() * pose.director.x());
        lanes.rate2[lane] = static_cast<float>(flight.rate * flight.rate);
      }
      std::fill_n(off_plates, kLanes, TimingWheel::horizon() - 1);
      if (rules_.has_base || rules_.has_lid) {
        plate_safe_ticks(rules_.kind_of(rods.front()).species, world.plates, lanes, static_cast<int>(rods.size()),
                         rules_.gravity, rules_.dt, now, TimingWheel::horizon() - 1, off_plates,
                         {rules_.has_base, rules_.has_lid, rules_.rest});
      }
      for (std::size_t lane = 0; lane < rods.size(); ++lane) {
        const int i = rods[lane];
        Tick safe = std::min(off_plates[lane], listed_ticks(world, i, now));
        if (rules_.walls) safe = std::min(safe, off_walls_ticks(world, i));
        worker.next.push_back(now + 1 + safe);
      }
    });
  });
  phase_times.lap(Phase::kBounds);
  for (const Worker& worker : workers_) {
    for (std::size_t k = 0; k < worker.mine.size(); ++k) rod_wheel_.set(worker.mine[k], worker.next[k]);
  }
  phase_times.lap(Phase::kSchedule);
}

/// Ticks for which rod i certainly touches no side wall.
Tick ScheduledStepper::off_walls_ticks(const World& world, int i) const {
  const double horizon = static_cast<double>(TimingWheel::horizon() - 1) * rules_.dt;
  const double time =
      wall_safe_time(*rules_.walls, rules_.box_side, rules_.kind_of(i).species, rods_[i].pose, world.rods[i], horizon);
  return static_cast<Tick>(time / rules_.dt * (1.0 - 1e-9));
}

/// Ticks for which the neighbour list certainly covers rod i.
Tick ScheduledStepper::listed_ticks(const World& world, int i, Tick now) {
  const Flight& flight = world.rods[i];
  RodRecord& record = records_[i];
  record.slack = slack_left(i, now);
  record.slack_at = now;
  if (record.slack < kLowSlack) measure_slack(i, now);
  // The segment turns at (p_z - n_z p.n) / |n_xy|^2, with p the precession and p.n a constant; |n_xy| changes by at
  // most |p| per time, so it keeps nine tenths for a while: up to the visit, which may come a tick later than said
  // here.
  const Vec3& n = rods_[i].pose.director;
  const Vec3& v = flight.velocity;
  const Vec3& p = flight.precession;
  const double flat2 = n.x() * n.x() + n.y() * n.y();
  double speed = std::sqrt(v.x() * v.x() + v.y() * v.y());
  double time = static_cast<double>(TimingWheel::horizon()) * rules_.dt;  // a rod at rest has all the time there is
  const double h = rules_.kind_of(i).species.half_length;
  if (h > 0 && flight.rate > 0) {  // a sphere has no segment
    const double upright = 0.1 * std::sqrt(flat2) / flight.rate - rules_.dt;
    if (!(upright > 0)) {  // it may turn any way at once: to be measured at the next tick
      record.slack = 0;
      record.slack_speed = 0;
      return 0;
    }
    time = std::min(time, upright);
    speed += h * (std::abs(p.z()) + std::abs(p.dot(n))) / (0.81 * flat2);
  }
  record.slack_speed = static_cast<float>(speed);
  if (speed > 0) time = std::min(time, std::max(static_cast<double>(record.slack), 0.0) / speed);
  return std::min(TimingWheel::horizon() - 1, static_cast<Tick>(time / rules_.dt * (1.0 - 1e-12)));
}

void ScheduledStepper::schedule_pairs(const World& world, Tick now) {
  to_bound_.clear();
  const auto list = [&](int p) {
    if (pair_marks_[p] & kListed) return;
    pair_marks_[p] |= kListed;
    to_bound_.push_back(p);
  };
  for (const int p : due_pairs_) list(p);
  for (Worker& worker : workers_) {
    for (const int i : worker.strayed) {
      for (const int p : neighbors_.pairs_of(i)) list(p);
    }
    worker.strayed.clear();
  }
  for (const int i : changed_) {
    if (marks_[i].n_steady == 0) continue;
    for (const int p : neighbors_.pairs_of(i)) {
      if (pair_marks_[p] & kSteady) list(p);
    }
  }
  if (to_bound_.empty()) return;

  to_pose_.clear();
  to_look_at_.clear();
  for (const int p : to_bound_) {
    for (const int i : pair_rods_[p]) {
      if (marks_[i].outlook_at == now) continue;
      marks_[i].outlook_at = now;
      to_look_at_.push_back(i);
      list_to_pose(i, now);
    }
  }
  phase_times.lap(Phase::kSchedule);
  const auto group = [this](int p) { return pair_group(p); };
  sort_by(group, to_bound_);
  pose(world, now);
  const auto ask = [&](int i) {
    prefetch(records_[i]);
    prefetch(outlooks_[i]);
  };
  share(to_look_at_, rod_owners_,
        [&](Worker& worker) { visit_ahead(worker.mine, ask, [&](int i) { outlooks_[i] = outlook(world, i, now); }); });
  share(to_bound_, pair_owners_, [&](Worker& worker) {
    worker.next.clear();
    worker.next_steady.clear();
    in_lanes(group, worker.mine, [&](std::span<const int> pairs) { bound_pairs(pairs, now, worker); });
  });
  phase_times.lap(Phase::kBounds);
  for (const Worker& worker : workers_) {
    for (std::size_t k = 0; k < worker.mine.size(); ++k) {
      const int p = worker.mine[k];
      pair_marks_[p] &= static_cast<std::uint8_t>(~kListed);
      mark_steady(p, worker.next_steady[k]);
      pair_wheel_.set(p, worker.next[k]);
    }
  }
  phase_times.lap(Phase::kSchedule);
}

/// Appends to the worker's `next` and `next_steady`, for up to kLanes pairs.
void ScheduledStepper::bound_pairs(std::span<const int> pairs, Tick now, Worker& worker) {
  PairLanes& lanes = worker.pair_lanes;
  const auto [kind_i, kind_j] = [&] {
    const auto& [i, j] = pair_rods_[pairs.front()];
    return std::pair(rules_.rod_kinds[i], rules_.rod_kinds[j]);
  }();
  HullSafeTimes hull;
  Vec3 D[kLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto& [i, j] = pair_rods_[pairs[lane]];
    D[lane] = nearest_image(rods_[i].pose.position, rods_[j].pose.position, rules_.box_side);
    lanes.set(static_cast<int>(lane), D[lane], outlooks_[i], outlooks_[j]);
  }
  const auto horizon = static_cast<float>(static_cast<double>(TimingWheel::horizon() - 1) * rules_.dt);
  hull_safe_times(hulls_[kind_i], hulls_[kind_j], lanes, kAllowance, horizon, hull);

  const auto per_dt = static_cast<float>((1.0 - 1e-5) / rules_.dt);
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    directions_[pairs[lane]] = {hull.direction[0][lane], hull.direction[1][lane], hull.direction[2][lane]};
    float steady = hull.steady[lane] * per_dt;
    float straying = hull.straying[lane] * per_dt;
    const auto& [rod_i, rod_j] = pair_rods_[pairs[lane]];
    if (steady < kShortBound && straying < kShortBound) {
      const SafeTime beads = bead_safe_time(lanes_[kind_i], outlooks_[rod_i], lanes_[kind_j], outlooks_[rod_j], D[lane],
                                            kAllowance, kBeadHorizon * static_cast<float>(rules_.dt));
      steady = std::max(steady, beads.steady * per_dt);
      straying = std::max(straying, beads.straying * per_dt);
    }
    const SafeTime images = image_safe_time(D[lane], outlooks_[rod_i], outlooks_[rod_j], kAllowance, rules_.box_side,
                                            reach_[kind_i] + reach_[kind_j], horizon);
    steady = std::min(steady, images.steady * per_dt);
    straying = std::min(straying, images.straying * per_dt);
    const bool is_steady = straying < kLongBound && straying * kMuchLonger < steady;
    worker.next_steady.push_back(is_steady);
    // Whether a pair is touching was found where free flight had brought its rods. Displaced since, they may overlap
    // and recede without being marked, if their hulls do: to be looked at again at once.
    const bool unmarked = hull.steady[lane] <= 0.0F && (rods_[rod_i].displaced || rods_[rod_j].displaced);
    worker.next.push_back(unmarked ? now + 1 : now + 1 + static_cast<Tick>(is_steady ? steady : straying));
  }
}

}  // namespace shaken
