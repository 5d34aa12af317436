// Rods in flight, and bounds on when they touch something.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>
#include <vector>

#include "sim/balance.h"
#include "sim/simulation.h"
#include "tests/support/good.h"
#include "tests/support/random_rods.h"

namespace shaken::test {

/// A rod that flies as in a shaken layer or slower, over longer horizons.
struct FlyingRod {
  Species species;
  Flight flight;
  Gravity gravity{9810};  ///< for a part of the rods on inclined plates
  double horizon = 0;

  void begin(Draw& draw, const Pose& pose, const Box& box) {
    horizon = 16e-3 * std::pow(25.0, draw.uniform(0, 1));
    const double speed = std::pow(10.0, draw.uniform(-1, 1)) / horizon;
    const double turning = draw.integer(0, 4) ? 0.5 * speed : 0.0;
    begin_flight(flight, 0, pose, {draw.integer(0, 9) ? draw.vector(speed) : Vec3(Vec3::Zero()), draw.vector(turning)},
                 box, species.inertia_par / species.inertia_perp);
    if (draw.integer(0, 3)) return;
    gravity.is_inclined = true;
    gravity.along = draw.vector(0.3 * speed / horizon).head<2>();
  }
  Pose pose() const { return {flight.position, flight.director}; }
};

/// How many rods were free at first, and of how many the bound was shorter than the horizon.
struct Tried {
  int n_free = 0, n_short = 0;
};

/// No bead of the rod touches before its bound. Where the plates are level, `share` gets the bound over the time after
/// which one does, if it is given.
template <class Rod>
void expect_free_until_bound(const Rod& rod, Tried& tried, std::vector<double>* share) {
  const double safe = rod.safe_time();
  const auto overlap_after = [&](double t) { return rod.overlap(pose_after(rod.flight, t, rod.gravity)); };
  ASSERT_TRUE(safe >= 0 && safe <= rod.horizon);
  if (overlap_after(0) > 0) {
    ASSERT_EQ(safe, 0);
    return;
  }
  ++tried.n_free;
  tried.n_short += safe < rod.horizon;
  constexpr int kSteps = 30;
  for (int step = 1; step <= kSteps && safe > 0; ++step) ASSERT_LE(overlap_after(safe * step / kSteps), 0) << step;
  if (share == nullptr || !(safe < rod.horizon) || rod.gravity.is_inclined) return;
  double hit = safe;
  while (hit < rod.horizon && !(overlap_after(hit) > 0)) hit += 1e-3 * rod.horizon;
  share->push_back(safe / std::min(hit, rod.horizon));
}

/// Half of these bounds are more than `median` of the true time, and none is more than that time.
inline void expect_tight(const char* bound, std::vector<double> share, double median) {
  std::sort(share.begin(), share.end());
  std::printf("%s / true time: median %.3f, lower quartile %.3f, lowest %.3f of %zu\n", bound, share[share.size() / 2],
              share[share.size() / 4], share.front(), share.size());
  EXPECT_GT(share[share.size() / 2], median) << bound;
  EXPECT_LE(share.back(), 1.0) << bound;
}

/// The rods of a system, from these places on with these velocities.
inline Simulation flying(const System& system, const std::vector<std::pair<Vec3, Vec3>>& rods) {
  World world = good(Simulation::start(system))->world();
  for (std::size_t i = 0; i < rods.size(); ++i) {
    Flight& flight = world.rods[i];
    std::tie(flight.position, flight.velocity) = rods[i];
    flight.precession = Vec3::Zero();
    flight.prepare();
  }
  world.start = content(world);
  return Simulation::start_from(world);
}

}  // namespace shaken::test
