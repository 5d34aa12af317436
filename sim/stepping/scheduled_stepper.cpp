// SPDX-License-Identifier: MIT
#include "sim/stepping/scheduled_stepper.h"

#include <numeric>
#include <utility>

#include "sim/core/heap_bytes.h"
#include "sim/core/prefetch.h"
#include "sim/stepping/rod_impacts.h"
#include "sim/stepping/surface_bounds.h"
#include "sim/stepping/surface_impacts.h"

namespace shaken {
namespace {

constexpr double kSkin = 0.4;  ///< of the neighbour list [mm]

}  // namespace

ScheduledStepper::ScheduledStepper(const World& world, int n_threads, int grain)
    : rules_(world),
      search_(rules_),
      neighbors_(world.species, world.species_of_rod, world.system.box_side, kSkin),
      loops_(n_threads, grain),
      rods_(world.rods.size()),
      changes_(world.rods.size()),
      reserves_(world.rods.size()),
      marks_(world.rods.size()),
      motion_bounds_(world.rods.size()),
      owners_(world.rods.size()),
      wheel_(world.rods.size()),
      pairs_(world.rods.size()) {
  if (rules_.impacts_at_instant) found_.resize(world.rods.size());
  // rods are numbered along the rows that they start in, so these are bands of the plane
  const std::size_t n = world.rods.size();
  for (std::size_t i = 0; i < n; ++i)
    owners_[i] = static_cast<std::uint8_t>(i * static_cast<std::size_t>(n_threads) / n);
}

std::size_t ScheduledStepper::bytes() const {
  std::size_t bytes = neighbors_.bytes() + wheel_.bytes() + pairs_.bytes();
  bytes += heap_bytes(rods_, found_, changes_, reserves_, marks_, motion_bounds_, owners_);
  bytes += heap_bytes(due_rods_, due_pairs_, contacts_, changed_, to_pose_, to_bound_motion_, to_schedule_, to_bound_,
                      may_change_, gained_, lost_, loops_.workers());
  for (const Worker& w : loops_.workers())
    bytes += heap_bytes(w.own, w.next, w.bead_contacts, w.contacts, w.turned, w.hit, w.to_place);
  return bytes;
}

std::optional<NumericalTrouble> ScheduledStepper::step(World& world, Tick now) {
  phase_times.start();
  list_due_rods(world, now);
  phase_times.lap(Phase::kSchedule);

  // 1. surfaces
  if (auto trouble = meet_surfaces_due(world, now)) return trouble;
  phase_times.lap(Phase::kSurfaces);

  // 2. detection
  list_due_pairs(world, now);
  phase_times.lap(Phase::kNeighbors);
  detect_due(world, now);
  detect_touching(world, now);
  sort_contacts(contacts_, rods_, rules_);
  phase_times.lap(Phase::kDetection);

  // 3. response
  if (auto trouble = collide_rods(contacts_, rods_, world, now, rules_)) return trouble;
  phase_times.lap(Phase::kResponse);

  // 4. storing
  list_hit(now);
  if (auto trouble = store_changed(world, now)) return trouble;
  phase_times.lap(Phase::kStoring);

  // what was visited, and what flies differently now, gets new bounds
  schedule_rods(world, now);
  list_pairs_to_bound(now);
  if (to_bound_.empty()) return {};
  bound_motions(world, now);
  schedule_pairs(now);
  return {};
}

void ScheduledStepper::list_due_rods(const World& world, Tick now) {
  if (is_new_) {
    due_rods_.resize(world.rods.size());
    std::iota(due_rods_.begin(), due_rods_.end(), 0);
  } else {
    wheel_.pop(now, due_rods_);
  }
}

// ---- poses at the tick

[[gnu::always_inline]] inline void ScheduledStepper::pose_rod(int i, const World& world, Tick now) {
  rods_[i] = rod_at_tick(world.rods[i], now, rules_);
  if (!found_.empty()) found_[i] = rods_[i].pose;
}

void ScheduledStepper::list_to_pose(int i, Tick now) {
  if (marks_[i].posed_at == now) return;
  marks_[i].posed_at = now;
  to_pose_.push_back(i);
}

void ScheduledStepper::pose_listed(const World& world, Tick now) {
  const auto ask = [&](int i) {
    prefetch(world.rods[i]);
    prefetch(rods_[i]);
  };
  loops_.run(to_pose_, owners_,
             [&](Worker& worker) { visit_ahead(worker.mine, ask, [&](int i) { pose_rod(i, world, now); }); });
}

// ---- 1. surfaces

std::optional<NumericalTrouble> ScheduledStepper::meet_surfaces_due(World& world, Tick now) {
  changed_.clear();
  if (due_rods_.empty()) return {};
  for (const int i : due_rods_) marks_[i].posed_at = marks_[i].listed_at = now;
  const PlateState plates = world.plates.at(now);
  const auto ask = [&](int i) {
    prefetch(world.rods[i]);
    prefetch(rods_[i]);
    prefetch(reserves_[i]);
  };
  loops_.run(due_rods_, owners_, [&](Worker& worker) {
    visit_ahead(worker.mine, ask, [&](int i) {
      pose_rod(i, world, now);
      if (reserves_[i].left(now, rules_.dt) < ListReserve::kLeast) {
        reserves_[i].measure(neighbors_, i, rods_[i].pose, now);
        if (reserves_[i].left(now, rules_.dt) < ListReserve::kLeast) worker.to_place.push_back(i);
      }
      auto trouble = meet_surfaces(i, rods_[i], world.rods[i], plates, now, rules_, worker.counters);
      if (trouble) worker.note(std::move(*trouble));
      if (rods_[i].changed) worker.hit.push_back(i);
    });
  });
  for (Worker& worker : loops_.workers()) {
    world.counters.add(worker.counters);
    worker.counters = {};
    for (const int i : worker.hit) {
      if (marks_[i].changed_at == now - 1) marks_[i].rests_at = now;
      list_changed(i, now);
    }
    worker.hit.clear();
  }
  return first_trouble();
}

void ScheduledStepper::Worker::note(NumericalTrouble met) {
  if (!trouble || met.rods < trouble->rods) trouble = std::move(met);
}

std::optional<NumericalTrouble> ScheduledStepper::first_trouble() const {
  std::optional<NumericalTrouble> first;
  for (const Worker& worker : loops_.workers()) {
    if (worker.trouble && (!first || worker.trouble->rods < first->rods)) first = worker.trouble;
  }
  return first;
}

// ---- 2. detection

void ScheduledStepper::list_due_pairs(const World& world, Tick now) {
  gained_.clear();
  if (is_new_) {
    std::vector<Pose> poses(world.rods.size());
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = found(static_cast<int>(i));
    neighbors_.build(poses);
    for (int i = 0; i < static_cast<int>(world.rods.size()); ++i)
      reserves_[i].measure(neighbors_, i, rods_[i].pose, now);
    gained_.resize(neighbors_.pairs().size());
    std::iota(gained_.begin(), gained_.end(), 0);
    is_new_ = false;
  }
  lost_.clear();
  for (Worker& worker : loops_.workers()) {
    for (const int i : worker.to_place) {
      neighbors_.place(i, found(i), gained_, lost_);
      reserves_[i].measure(neighbors_, i, rods_[i].pose, now);
    }
    worker.to_place.clear();
  }
  pairs_.make_room(neighbors_.pairs().size());
  for (const int p : lost_) pairs_.remove(p);
  pairs_.wheel().pop(now, due_pairs_);
  for (const int p : gained_) {
    const NeighborList::Pair& pair = neighbors_.pairs()[p];
    if (pair.i < 0 || pairs_.is_used(p)) continue;  // lost again, or met twice
    pairs_.add(p, {pair.i, pair.j}, owners_[pair.i]);
    due_pairs_.push_back(p);
  }
}

bool ScheduledStepper::find_contacts(int p, Worker& worker) {
  const auto& [i, j] = pairs_.rods(p);
  return search_.find(pairs_.rods(p), found(i), found(j), pairs_.direction(p), worker.bead_contacts, worker.contacts);
}

void ScheduledStepper::gather_contacts(Worker& worker) {
  contacts_.insert(contacts_.end(), worker.contacts.begin(), worker.contacts.end());
  worker.contacts.clear();
}

void ScheduledStepper::detect_due(const World& world, Tick now) {
  contacts_.clear();
  if (due_pairs_.empty()) return;
  to_pose_.clear();
  for (const int p : due_pairs_) {
    pairs_.set_detected(p, now);
    for (const int i : pairs_.rods(p)) list_to_pose(i, now);
  }
  pose_listed(world, now);
  loops_.run(due_pairs_, pairs_.owners(), [&](Worker& worker) {
    for (const int p : worker.mine) {
      if (find_contacts(p, worker) != pairs_.is_touching(p)) worker.turned.push_back(p);
    }
  });
  for (Worker& worker : loops_.workers()) {
    gather_contacts(worker);
    for (const int p : worker.turned) pairs_.turn_touching(p);
    worker.turned.clear();
  }
}

// Beads that overlap but recede are left alone for a while. An impulse on one of the rods can make them approach within
// the very tick, though, so wherever a rod may be hit, its touching pairs take part in that tick's response.
void ScheduledStepper::detect_touching(const World& world, Tick now) {
  may_change_.clear();
  for (const int i : changed_) {
    if (pairs_.n_touching(i) > 0) may_change_.push_back(i);
  }
  std::size_t n_seen = 0;
  const auto note_contacts = [&] {
    for (; n_seen < contacts_.size(); ++n_seen) {
      for (const int i : {contacts_[n_seen].i, contacts_[n_seen].j}) {
        if (pairs_.n_touching(i) > 1) may_change_.push_back(i);  // in more than this pair
      }
    }
  };
  note_contacts();
  Worker& worker = loops_.workers().front();
  for (std::size_t m = 0; m < may_change_.size(); ++m) {
    for (const int p : neighbors_.pairs_of(may_change_[m])) {
      if (!pairs_.is_touching(p) || pairs_.detected_at(p) == now) continue;
      due_pairs_.push_back(p);
      pairs_.set_detected(p, now);
      to_pose_.clear();
      for (const int rod : pairs_.rods(p)) list_to_pose(rod, now);
      pose_listed(world, now);
      if (!find_contacts(p, worker)) pairs_.turn_touching(p);
      gather_contacts(worker);
    }
    note_contacts();
  }
}

// ---- 4. storing

void ScheduledStepper::list_changed(int i, Tick now) {
  if (marks_[i].changed_at == now) return;
  marks_[i].changed_at = now;
  changed_.push_back(i);
}

void ScheduledStepper::list_hit(Tick now) {
  // A rod that a surface hits, and that was hit in the tick before, rests on it as a rule: it is as good as sure to be
  // hit in the next tick, too (four of five visits, 99 % of the time), and needs no bound to know it.
  to_schedule_.clear();
  for (const int i : due_rods_) {
    if (marks_[i].rests_at == now) {
      wheel_.set(i, now + 1);
    } else {
      to_schedule_.push_back(i);
    }
  }
  for (const PairContact& contact : contacts_) {
    for (const int i : {contact.i, contact.j}) {
      if (!rods_[i].changed) continue;
      list_changed(i, now);
      if (marks_[i].listed_at == now) continue;
      marks_[i].listed_at = now;
      to_schedule_.push_back(i);
    }
  }
}

std::optional<NumericalTrouble> ScheduledStepper::store_changed(World& world, Tick now) {
  loops_.run(changed_, owners_, [&](Worker& worker) {
    for (const int i : worker.mine) {
      if (auto trouble = check_motion(i, rods_[i], now, rules_)) worker.note(std::move(*trouble));
    }
  });
  if (auto trouble = first_trouble()) return trouble;
  const auto slow = static_cast<double>(search_.slow());
  loops_.run(changed_, owners_, [&](Worker& worker) {
    for (const int i : worker.mine) {
      Flight& flight = world.rods[i];
      const Vec3 velocity = velocity_at(flight, now, rules_);
      const Vec3 precession = flight.precession;
      const double rate = flight.rate;
      store(i, flight, rods_[i], now, rules_);
      const bool displaced = rods_[i].displaced;
      if (displaced) reserves_[i].measure(neighbors_, i, rods_[i].pose, now);
      if (marks_[i].rests_at == now) reserves_[i].cover_tick(flight, rules_.species_of(i).half_length, now, rules_.dt);
      // A rod that was displaced twice is where no flight with one hit led it. One that is fast may come near another
      // image, of which no line tells.
      const bool fast = std::max(std::abs(flight.velocity.x()), std::abs(flight.velocity.y())) >= slow;
      changes_[i] = (displaced && rods_[i].hit_again) || fast
                        ? MotionChange::unknown()
                        : MotionChange(flight.velocity - velocity, flight.precession - precession, flight.director,
                                       rate, flight.rate, rules_.species_of(i).half_length, displaced ? rules_.dt : 0);
    }
  });
  return {};
}

// ---- schedules

void ScheduledStepper::schedule_rods(const World& world, Tick now) {
  constexpr Tick kHorizon = TimingWheel::horizon() - 1;
  const Groups groups(rules_.species.size() > 1, [this](int i) { return species_index(i); });
  groups.sort(to_schedule_);
  loops_.run(to_schedule_, owners_, [&](Worker& worker) {
    worker.next.clear();
    groups.in_lanes(worker.mine, [&](std::span<const int> rods) {
      Tick ticks[kLanes];
      off_surface_ticks(rods, world, rods_, now, kHorizon, rules_, worker.plate_lanes, ticks);
      for (std::size_t lane = 0; lane < rods.size(); ++lane) {
        const int i = rods[lane];
        const Tick covered = reserves_[i].covered_ticks(neighbors_, i, world.rods[i], rods_[i].pose,
                                                        rules_.species_of(i).half_length, now, rules_.dt, kHorizon);
        worker.next.push_back(now + 1 + std::min(ticks[lane], covered));
      }
    });
  });
  phase_times.lap(Phase::kBounds);
  for (const Worker& worker : loops_.workers()) {
    for (std::size_t k = 0; k < worker.mine.size(); ++k) wheel_.set(worker.mine[k], worker.next[k]);
  }
  phase_times.lap(Phase::kSchedule);
}

void ScheduledStepper::list_pairs_to_bound(Tick now) {
  const auto dt = static_cast<float>(rules_.dt);
  to_bound_.clear();
  for (const int p : due_pairs_) pairs_.list(p, to_bound_);
  const std::size_t n = changed_.size();
  for (std::size_t k = 0; k < n; ++k) {
    // what pairs a rod has is known only when their numbers are here, so these are asked for first
    if (k + 4 < n) neighbors_.prefetch(changed_[k + 4]);
    if (k + 2 < n) {
      for (const int p : neighbors_.pairs_of(changed_[k + 2])) pairs_.prefetch(p);
    }
    const int i = changed_[k];
    for (const int p : neighbors_.pairs_of(i)) {
      if (!pairs_.is_listed(p) && !pairs_.tighten(p, i, changes_[i], now, dt)) pairs_.list(p, to_bound_);
    }
  }
}

// Flattened: or else each of its many appends to a list is a call: 2 % of all instructions (callgrind).
[[gnu::flatten]] void ScheduledStepper::bound_motions(const World& world, Tick now) {
  to_pose_.clear();
  to_bound_motion_.clear();
  for (const int p : to_bound_) {
    for (const int i : pairs_.rods(p)) {
      if (marks_[i].bounded_at == now) continue;
      marks_[i].bounded_at = now;
      to_bound_motion_.push_back(i);
      list_to_pose(i, now);
    }
  }
  phase_times.lap(Phase::kSchedule);
  pose_listed(world, now);
  const auto ask = [&](int i) { prefetch(motion_bounds_[i]); };
  loops_.run(to_bound_motion_, owners_, [&](Worker& worker) {
    visit_ahead(worker.mine, ask, [&](int i) {
      const Flight& flight = world.rods[i];
      motion_bounds_[i] =
          motion_bound(flight, velocity_at(flight, now, rules_), rods_[i].pose.director, search_.slow());
    });
  });
}

void ScheduledStepper::schedule_pairs(Tick now) {
  const int n_species = static_cast<int>(rules_.species.size());
  const Groups groups(n_species > 1, [&](int p) {
    const auto& [i, j] = pairs_.rods(p);
    return species_index(i) * n_species + species_index(j);
  });
  groups.sort(to_bound_);
  loops_.run(to_bound_, pairs_.owners(), [&](Worker& worker) {
    worker.next.clear();
    groups.in_lanes(worker.mine, [&](std::span<const int> pairs) { bound_pairs(pairs, now, worker); });
  });
  phase_times.lap(Phase::kBounds);
  for (const Worker& worker : loops_.workers()) {
    for (std::size_t k = 0; k < worker.mine.size(); ++k) {
      const int p = worker.mine[k];
      pairs_.unlist(p);
      pairs_.wheel().set(p, worker.next[k]);
    }
  }
  phase_times.lap(Phase::kSchedule);
}

/// Appends to the worker's `next`, for up to kLanes pairs.
void ScheduledStepper::bound_pairs(std::span<const int> pairs, Tick now, Worker& worker) {
  PairRods rods[kLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) rods[lane] = pairs_.rods(pairs[lane]);
  PairBounds bounds;
  search_.bound({rods, pairs.size()}, rods_, motion_bounds_, worker.pair_lanes, bounds);
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    pairs_.direction(pairs[lane]) = bounds.direction[lane];
    pairs_.set_line(pairs[lane], bounds.line[lane], bounds.all_round[lane]);
    // Whether a pair is touching was found where free flight had brought its rods. Displaced since, they may overlap
    // and recede without being marked, if their hulls do: to be visited again at once.
    const auto& [i, j] = rods[lane];
    const bool unmarked = bounds.hulls_overlap[lane] && (rods_[i].displaced || rods_[j].displaced);
    worker.next.push_back(now + 1 + (unmarked ? 0 : bounds.ticks[lane]));
  }
}

}  // namespace shaken
