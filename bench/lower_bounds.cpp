// SPDX-License-Identifier: MIT

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "base/clock.h"
#include "bench/speed.h"
#include "sim/contact/impulse.h"
#include "sim/motion/flight.h"

namespace shaken::bench {
namespace {

constexpr int kBatches = 7;          ///< of which the fastest counts
constexpr double kBatchTime = 0.02;  ///< CPU time of one batch, at least [s]
constexpr std::size_t kMostPairs = 2000;
/// Rods whose centres are further apart than this, in lengths, have no part in the sample of pairs.
constexpr double kPairReach = 1.1;

/// What does not change from impulse to impulse.
struct Rules {
  explicit Rules(const World& world)
      : species(world.species[0]),
        inverse(inverse_inertia(world.species[0])),
        ratio(world.species[0].inertia_par / world.species[0].inertia_perp),
        gravity(world.system.gravity),
        dt(world.system.dt),
        side(world.system.box_side),
        now(world.tick),
        rod_rod(world.system.rod_rod),
        rod_base(world.system.rod_base),
        plate_velocity(world.plates.at(world.tick).velocity) {}
  const Species& species;
  InverseInertia inverse;
  double ratio, gravity, dt, side;
  Tick now;
  ContactParameters rod_rod, rod_base;
  double plate_velocity;
};

struct RodNow {
  Pose pose;
  Motion motion;
};

RodNow evaluate(const Flight& flight, const Rules& rules) {
  const double tau = static_cast<double>(rules.now - flight.since) * rules.dt;
  const Pose pose = pose_after(flight, tau, rules.gravity);
  return {pose, motion_after(flight, tau, rules.gravity, pose.director, rules.ratio)};
}

void store(Flight& flight, const RodNow& rod, const Rules& rules) {
  begin_flight(flight, rules.now, rod.pose, rod.motion, rules.side, rules.ratio);
}

/// An impulse from the plate on whose side (+1: base, -1: lid) `offset` along the rod comes first.
struct PlateHit {
  int rod;
  double side;
  double offset;
};

void hit_plate(const PlateHit& hit, Flight& flight, const Rules& rules) {
  RodNow rod = evaluate(flight, rules);
  const Vec3 normal(0, 0, hit.side);
  const Vec3 arm = hit.offset * rod.pose.director - rules.species.end_radius * normal;
  Vec3 u = point_velocity(rod.motion, arm);
  u.z() -= rules.plate_velocity;
  const Mat3 K = point_compliance(rules.inverse, rod.pose.director, arm);
  const Vec3 P = newton_coulomb_impulse(K, normal, u, rules.rod_base);
  apply_impulse(rod.motion, rules.inverse, rod.pose.director, arm, P);
  store(flight, rod, rules);
}

/// One hit for every rod, in random order, as they come in a run: its lower end by the base or its upper end by the
/// lid, whichever approaches.
std::vector<PlateHit> plate_hits(const std::vector<Flight>& rods, const Rules& rules) {
  std::vector<PlateHit> hits;
  for (int i = 0; i < static_cast<int>(rods.size()); ++i) {
    const RodNow rod = evaluate(rods[i], rules);
    for (const double side : {1.0, -1.0}) {
      const double offset = std::copysign(rules.species.half_length, -side * rod.pose.director.z());
      const Vec3 arm = offset * rod.pose.director - rules.species.end_radius * Vec3(0, 0, side);
      if (side * (point_velocity(rod.motion, arm).z() - rules.plate_velocity) < 0) {
        hits.push_back({i, side, offset});
        break;
      }
    }
  }
  std::shuffle(hits.begin(), hits.end(), std::mt19937_64(1));
  return hits;
}

/// An impulse between two rods, with the beads and the normal that detection would hand over.
struct RodHit {
  int i, j;
  int bead_i, bead_j;
  Vec3 normal;
};

Vec3 arm_of(const Pose& pose, int bead, const Vec3& normal, const Rules& rules) {
  return rules.species.bead_offset[bead] * pose.director + rules.species.bead_radius[bead] * normal;
}

void hit_rods(const RodHit& hit, Flight& flight_i, Flight& flight_j, const Rules& rules) {
  RodNow i = evaluate(flight_i, rules);
  RodNow j = evaluate(flight_j, rules);
  const Vec3 arm_i = arm_of(i.pose, hit.bead_i, hit.normal, rules);
  const Vec3 arm_j = arm_of(j.pose, hit.bead_j, -hit.normal, rules);
  const Vec3 u = point_velocity(j.motion, arm_j) - point_velocity(i.motion, arm_i);
  const Mat3 K =
      point_compliance(rules.inverse, i.pose.director, arm_i) + point_compliance(rules.inverse, j.pose.director, arm_j);
  const Vec3 P = newton_coulomb_impulse(K, hit.normal, u, rules.rod_rod);
  apply_impulse(j.motion, rules.inverse, j.pose.director, arm_j, P);
  apply_impulse(i.motion, rules.inverse, i.pose.director, arm_i, -P);
  store(flight_i, i, rules);
  store(flight_j, j, rules);
}

/// The closest beads of two rods as a hit; the distance of their surfaces goes to `gap`.
RodHit closest_beads(int i, int j, const Pose& pose_i, const Pose& pose_j, const Vec3& D, const Species& species,
                     double& gap) {
  RodHit hit{i, j, 0, 0, Vec3::UnitZ()};
  gap = std::numeric_limits<double>::infinity();
  for (int a = 0; a < species.n_beads(); ++a) {
    for (int b = 0; b < species.n_beads(); ++b) {
      const Vec3 apart = D + species.bead_offset[b] * pose_j.director - species.bead_offset[a] * pose_i.director;
      const double distance = apart.norm();
      const double surfaces = distance - species.bead_radius[a] - species.bead_radius[b];
      if (surfaces >= gap || !(distance > 0)) continue;
      gap = surfaces;
      hit.bead_i = a;
      hit.bead_j = b;
      hit.normal = apart / distance;
    }
  }
  return hit;
}

/// Pairs of approaching neighbours, no rod twice so that each can be hit from its own state; the nearest partner first.
std::vector<RodHit> rod_hits(const std::vector<Flight>& rods, const Rules& rules) {
  std::vector<RodNow> now;
  now.reserve(rods.size());
  for (const Flight& flight : rods) now.push_back(evaluate(flight, rules));
  std::vector<bool> taken(rods.size(), false);
  std::vector<RodHit> hits;
  const double reach = kPairReach * 2 * (rules.species.half_length + rules.species.end_radius);
  for (int i = 0; i < static_cast<int>(rods.size()) && hits.size() < kMostPairs; ++i) {
    if (taken[i]) continue;
    RodHit best{};
    double least = std::numeric_limits<double>::infinity();
    for (int j = i + 1; j < static_cast<int>(rods.size()); ++j) {
      if (taken[j]) continue;
      Vec3 D = now[j].pose.position - now[i].pose.position;
      for (int c = 0; c < 2; ++c) D[c] -= rules.side * std::nearbyint(D[c] / rules.side);
      if (D.squaredNorm() > reach * reach) continue;
      double gap = 0;
      const RodHit hit = closest_beads(i, j, now[i].pose, now[j].pose, D, rules.species, gap);
      const Vec3 u = point_velocity(now[j].motion, arm_of(now[j].pose, hit.bead_j, -hit.normal, rules)) -
                     point_velocity(now[i].motion, arm_of(now[i].pose, hit.bead_i, hit.normal, rules));
      if (gap >= least || !(u.dot(hit.normal) < 0)) continue;
      least = gap;
      best = hit;
    }
    if (!std::isfinite(least)) continue;
    taken[best.i] = taken[best.j] = true;
    hits.push_back(best);
  }
  return hits;
}

/// CPU time of one of `work(items[k])`, the least of several batches. `reset` is called, untimed, before every pass
/// over all items.
template <class Item, class Work, class Reset>
double time_each(const std::vector<Item>& items, const Work& work, const Reset& reset) {
  if (items.empty()) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < kBatches; ++batch) {
    double taken = 0;
    std::size_t done = 0;
    while (taken < kBatchTime) {
      reset();
      const double start = cpu_seconds();
      for (const Item& item : items) work(item);
      taken += cpu_seconds() - start;
      done += items.size();
    }
    least = std::min(least, taken / static_cast<double>(done));
  }
  return least;
}

/// Reads all of a state and writes it back; the compiler must not see through it.
void touch(Flight& flight) {
  std::array<unsigned char, sizeof(Flight)> copy;
  auto* state = reinterpret_cast<unsigned char*>(&flight);
  std::memcpy(copy.data(), state, copy.size());
  asm volatile("" : : "r"(copy.data()) : "memory");
  std::memcpy(state, copy.data(), copy.size());
  asm volatile("" : : "r"(state) : "memory");
}

}  // namespace

LowerBounds measure_lower_bounds(const World& world) {
  const Rules rules(world);
  std::vector<Flight> rods = world.rods;
  const auto restore = [&] { std::copy(world.rods.begin(), world.rods.end(), rods.begin()); };

  LowerBounds bounds;
  bounds.plate_impulse = time_each(
      plate_hits(world.rods, rules), [&](const PlateHit& hit) { hit_plate(hit, rods[hit.rod], rules); }, restore);
  bounds.rod_impulse = time_each(
      rod_hits(world.rods, rules), [&](const RodHit& hit) { hit_rods(hit, rods[hit.i], rods[hit.j], rules); }, restore);

  std::mt19937_64 random(2);
  std::vector<int> places(std::max<std::size_t>(rods.size(), 100'000));
  for (int& place : places) place = static_cast<int>(random() % rods.size());
  bounds.state_access = time_each(
      places, [&](int place) { touch(rods[place]); }, [] {});
  return bounds;
}

}  // namespace shaken::bench
