// SPDX-License-Identifier: MIT
// Rods that move by themselves because their ends differ, and rough plates that turn them: nothing in the program says
// that they should, it comes out of the impacts.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "sim/simulation.h"

namespace shaken {
namespace {

struct Drift {
  double mean = 0;   ///< of v . n over rods and time [mm/s]
  double error = 0;  ///< standard error, from the rods' own means
};

/// Mean velocity along the director of 20 rods in a dilute gas, after one second of settling.
Drift drift_of(Profile profile, double plate_friction) {
  Scene scene;
  scene.rod = {.length = 4.5, .mid_diameter = 0.8, .end_diameter = 0.4, .n_beads = 15, .profile = profile};
  scene.n_rods = 20;
  scene.box_side = 25;
  scene.start = Start::kRandom;
  scene.rod_base.friction = scene.rod_lid.friction = plate_friction;
  auto simulation = Simulation::start(scene);
  std::vector<double> along(static_cast<std::size_t>(scene.n_rods), 0.0);
  int n_frames = 0;
  for (Tick k = 250000; k <= 1250000; k += 1000) {
    EXPECT_FALSE(simulation->advance_to(k).has_value());
    const Snapshot now = simulation->snapshot();
    for (std::size_t i = 0; i < along.size(); ++i) along[i] += now.velocity[i].dot(now.director[i]);
    ++n_frames;
  }
  Drift drift;
  double squares = 0;
  const auto n = static_cast<double>(along.size());
  for (const double sum : along) {
    drift.mean += sum / n_frames / n;
    squares += sum / n_frames * (sum / n_frames);
  }
  drift.error = std::sqrt((squares / n - drift.mean * drift.mean) / (n - 1));
  std::printf("plate friction %g: mean of v.n = %.2f +- %.2f mm/s\n", plate_friction, drift.mean, drift.error);
  return drift;
}

TEST(PolarRods, MoveFromTheThickToTheThinEndOnStickyPlates) {
  const Drift polar = drift_of(Profile::kPolar, 0.3);
  EXPECT_GT(polar.mean, 3.0);
  EXPECT_GT(polar.mean, 6 * polar.error);
}

TEST(PolarRods, MoveTheOtherWayOnSlipperyPlates) {
  const Drift polar = drift_of(Profile::kPolar, 0.01);
  EXPECT_LT(polar.mean, -0.3);
  EXPECT_LT(polar.mean, -3 * polar.error);
}

TEST(PolarRods, SymmetricOnesDoNot) {
  for (const double friction : {0.01, 0.3}) {
    const Drift symmetric = drift_of(Profile::kSymmetric, friction);
    EXPECT_LT(std::abs(symmetric.mean), 4 * symmetric.error + 0.05) << friction;
  }
}

/// Mean square angle that rods have turned in the plane after half a second [rad^2].
double turned(double noise) {
  Scene scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.n_rods = 60;
  scene.box_side = 30;
  scene.start = Start::kRandom;
  scene.rotational_noise = noise;
  auto simulation = Simulation::start(scene);
  const auto angle = [](const Vec3& n) { return std::atan2(n.y(), n.x()); };
  EXPECT_FALSE(simulation->advance_to(125000).has_value());
  Snapshot before = simulation->snapshot();
  std::vector<double> sum(before.n_rods(), 0.0);
  for (Tick k = 125500; k <= 250000; k += 500) {
    EXPECT_FALSE(simulation->advance_to(k).has_value());
    const Snapshot now = simulation->snapshot();
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double turn = angle(now.director[i]) - angle(before.director[i]);
      sum[i] += turn - 2 * kPi * std::nearbyint(turn / (2 * kPi));
    }
    before = now;
  }
  double mean2 = 0;
  for (const double angle_turned : sum) mean2 += angle_turned * angle_turned / static_cast<double>(sum.size());
  EXPECT_EQ(simulation->world().counters.noise_kicks > 0, noise > 0);
  std::printf("noise %g rad/mm: mean square angle in 0.5 s = %.1f rad^2\n", noise, mean2);
  return mean2;
}

// D_r grows as the square of the noise. Of 60 rods a mean square is known to 18 %.
TEST(RotationalNoise, TurnsRodsMoreTheStrongerItIs) {
  const double none = turned(0);
  const double little = turned(0.02);
  const double more = turned(0.06);
  EXPECT_GT(little, 1.5 * none);
  EXPECT_GT((more - none) / (little - none), 3.0);
  EXPECT_LT((more - none) / (little - none), 14.0);
}

}  // namespace
}  // namespace shaken
