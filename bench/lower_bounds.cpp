// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "base/clock.h"
#include "bench/nearest_beads.h"
#include "bench/speed.h"
#include "sim/contact/impulse.h"
#include "sim/motion/flight.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken::bench {
namespace {

constexpr int kBatches = 7;          ///< of which the fastest counts
constexpr double kBatchTime = 0.02;  ///< CPU time of one batch, at least [s]
constexpr std::size_t kMostPairs = 2000;
constexpr double kPairReach = 1.1;  ///< rods whose centres are further apart than this have no part [rod lengths]

struct RodNow {
  Pose pose;
  Motion motion;
};

/// An impulse from the plate on whose side (+1: base, -1: lid) `offset` along the rod comes first.
struct PlateHit {
  int rod;
  double side;
  double offset;
};

/// An impulse between two rods, with the beads and the normal that detection would hand over.
struct RodHit {
  int i, j;
  NearestBeads beads;
};

/// The rods of a state, and what an impulse does to them.
class HitRods {
 public:
  explicit HitRods(const World& world)
      : world_(world),
        inverse_(inverse_inertia(species_)),
        ratio_(species_.inertia_par / species_.inertia_perp),
        plate_velocity_(world.plates.at(world.tick).velocity),
        rods_(world.rods) {}

  /// As they are in the world.
  void restore() { std::copy(world_.rods.begin(), world_.rods.end(), rods_.begin()); }
  std::vector<Flight>& rods() { return rods_; }

  void hit(const PlateHit& hit) {
    RodNow rod = evaluate(hit.rod);
    const Vec3 normal(0, 0, hit.side);
    const Vec3 arm = arm_of(hit, rod);
    const Vec3 u = point_velocity(rod.motion, arm) - Vec3(0, 0, plate_velocity_);
    const Mat3 K = point_compliance(inverse_, rod.pose.director, arm);
    const Vec3 P = newton_coulomb_impulse(K, normal, u, world_.system.rod_base);
    apply_impulse(rod.motion, inverse_, rod.pose.director, arm, P);
    store(hit.rod, rod);
  }

  void hit(const RodHit& hit) {
    RodNow i = evaluate(hit.i), j = evaluate(hit.j);
    const Vec3 arm_i = arm_of(hit.beads.i, i, hit.beads.normal);
    const Vec3 arm_j = arm_of(hit.beads.j, j, -hit.beads.normal);
    const Vec3 u = point_velocity(j.motion, arm_j) - point_velocity(i.motion, arm_i);
    const Mat3 K =
        point_compliance(inverse_, i.pose.director, arm_i) + point_compliance(inverse_, j.pose.director, arm_j);
    const Vec3 P = newton_coulomb_impulse(K, hit.beads.normal, u, world_.system.rod_rod);
    apply_impulse(j.motion, inverse_, j.pose.director, arm_j, P);
    apply_impulse(i.motion, inverse_, i.pose.director, arm_i, -P);
    store(hit.i, i);
    store(hit.j, j);
  }

  /// One for every rod, in random order, as they come in a run: its lower end by the base or its upper end by the lid,
  /// whichever approaches.
  std::vector<PlateHit> plate_hits() const {
    std::vector<PlateHit> hits;
    for (int i = 0; i < n_rods(); ++i) {
      const RodNow rod = evaluate(i);
      for (const double side : {1.0, -1.0}) {
        const PlateHit hit{i, side, std::copysign(species_.half_length, -side * rod.pose.director.z())};
        if (side * (point_velocity(rod.motion, arm_of(hit, rod)).z() - plate_velocity_) >= 0) continue;
        hits.push_back(hit);
        break;
      }
    }
    std::shuffle(hits.begin(), hits.end(), std::mt19937_64(1));
    return hits;
  }

  /// Of approaching neighbours, the nearest first and no rod twice, so that each can be hit from its own state.
  std::vector<RodHit> rod_hits() const {
    std::vector<RodNow> now;
    now.reserve(rods_.size());
    for (int i = 0; i < n_rods(); ++i) now.push_back(evaluate(i));
    std::vector<RodHit> near;
    const double reach = kPairReach * 2 * (species_.half_length + species_.end_radius);
    for (int i = 0; i < n_rods(); ++i) {
      for (int j = i + 1; j < n_rods(); ++j) {
        const Vec3 D = nearest_image(now[i].pose.position, now[j].pose.position, world_.system.box_side);
        if (D.squaredNorm() > reach * reach) continue;
        const NearestBeads beads = nearest_beads(species_, now[i].pose.director, now[j].pose.director, D);
        const Vec3 u = point_velocity(now[j].motion, arm_of(beads.j, now[j], -beads.normal)) -
                       point_velocity(now[i].motion, arm_of(beads.i, now[i], beads.normal));
        if (u.dot(beads.normal) < 0) near.push_back({i, j, beads});
      }
    }
    std::sort(near.begin(), near.end(), [](const RodHit& a, const RodHit& b) { return a.beads.gap < b.beads.gap; });
    std::vector<bool> is_taken(rods_.size(), false);
    std::vector<RodHit> hits;
    for (const RodHit& hit : near) {
      if (is_taken[hit.i] || is_taken[hit.j] || hits.size() == kMostPairs) continue;
      is_taken[hit.i] = is_taken[hit.j] = true;
      hits.push_back(hit);
    }
    return hits;
  }

 private:
  int n_rods() const { return static_cast<int>(rods_.size()); }
  RodNow evaluate(int i) const {
    const Flight& flight = rods_[i];
    const double tau = static_cast<double>(world_.tick - flight.since) * world_.system.dt;
    const Pose pose = pose_after(flight, tau, world_.system.gravity);
    return {pose, motion_after(flight, tau, world_.system.gravity, pose.director, ratio_)};
  }
  void store(int i, const RodNow& rod) {
    begin_flight(rods_[i], world_.tick, rod.pose, rod.motion, world_.system.box_side, ratio_);
  }
  Vec3 arm_of(const PlateHit& hit, const RodNow& rod) const {
    return hit.offset * rod.pose.director - species_.end_radius * Vec3(0, 0, hit.side);
  }
  Vec3 arm_of(int bead, const RodNow& rod, const Vec3& normal) const {
    return species_.bead_offset[bead] * rod.pose.director + species_.bead_radius[bead] * normal;
  }

  const World& world_;
  const Species& species_ = world_.species[0];
  InverseInertia inverse_;
  double ratio_, plate_velocity_;
  std::vector<Flight> rods_;
};

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
  HitRods rods(world);
  const auto hit = [&](const auto& one) { rods.hit(one); };
  const auto restore = [&] { rods.restore(); };
  LowerBounds bounds;
  bounds.plate_impulse = time_each(rods.plate_hits(), hit, restore);
  bounds.rod_impulse = time_each(rods.rod_hits(), hit, restore);

  std::mt19937_64 random(2);
  std::vector<int> places(std::max<std::size_t>(world.rods.size(), 100'000));
  for (int& place : places) place = static_cast<int>(random() % world.rods.size());
  bounds.state_access = time_each(
      places, [&](int place) { touch(rods.rods()[place]); }, [] {});
  return bounds;
}

}  // namespace shaken::bench
