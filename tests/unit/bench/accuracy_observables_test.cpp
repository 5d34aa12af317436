// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "bench/accuracy/averaged.h"
#include "bench/accuracy/errors.h"

namespace shaken::bench {
namespace {

System dilute() {
  System scene;
  scene.n_rods = 5;
  scene.box_side = 30;
  scene.dt = 4e-6;
  scene.start = Start::kRandom;
  return scene;
}

Simulation started(const System& scene) {
  auto simulation = Simulation::start(scene);
  if (!simulation) throw std::runtime_error(simulation.error().message);
  return std::move(simulation).value();
}

TEST(Observables, AreThoseOfTheSnapshot) {
  const Simulation simulation = started(dilute());
  ObservableSeries series;
  series.sample(simulation);
  const Snapshot rods = simulation.snapshot();
  double xy = 0, z = 0, turn = 0, tilt = 0;
  for (std::size_t i = 0; i < rods.n_rods(); ++i) {
    xy += (std::pow(rods.velocity[i].x(), 2) + std::pow(rods.velocity[i].y(), 2)) / 2 / 5;
    z += std::pow(rods.velocity[i].z(), 2) / 5;
    turn += rods.angular_velocity[i].squaredNorm() / 2 / 5;  // no rod spins at the start
    tilt += std::pow(rods.director[i].z(), 2) / 5;
  }
  EXPECT_NEAR(series.values("T_xy").at(0), xy, 1e-9 * xy);
  EXPECT_NEAR(series.values("T_z").at(0), z, 1e-9 * z);
  EXPECT_NEAR(series.values("T_rot").at(0), turn, 1e-9 * turn);
  EXPECT_NEAR(series.values("rms_n_z").at(0), std::sqrt(tilt), 1e-12);
  EXPECT_EQ(series.values("rod_impulses").size(), 0u) << "a rate needs two samples";
}

TEST(Observables, OfOneTiltedRod) {
  System scene = dilute();
  scene.n_rods = 1;
  scene.gap = 20;
  World world = empty_world(scene);
  Flight flight;
  flight.position = {15, 15, 10};
  flight.director = {0.6 * std::sqrt(0.96), 0.8 * std::sqrt(0.96), 0.2};
  flight.velocity = {-6, -8, 3};  // -10 mm/s along the rod, which points up: against its tilt
  flight.prepare();
  world.rods = {flight};
  Simulation simulation = Simulation::start_from(world);
  ObservableSeries series;
  series.sample(simulation);
  EXPECT_NEAR(series.values("drift").at(0), 10, 1e-9);
  EXPECT_EQ(series.values("hit").at(0), 1) << "its flight has only begun";
  ASSERT_FALSE(simulation.advance_to(16));  // 64 us
  series.sample(simulation);
  EXPECT_EQ(series.values("hit").at(1), 0);
  world.rods[0].director.z() = 0.3;  // too steep to count
  world.rods[0].director.normalize();
  world.rods[0].prepare();
  series.sample(Simulation::start_from(world));
  EXPECT_EQ(series.values("drift").size(), 2u);
}

TEST(Observables, DisplacementsAreOverTheLag) {
  System scene = dilute();
  scene.amplitude = 0;
  scene.gap = 100;  // free flight
  scene.n_rods = 1;
  World world = empty_world(scene);
  Flight flight;
  flight.position = {29, 15, 50};
  flight.velocity = {30, 40, 0};
  flight.prepare();
  world.rods = {flight};
  Simulation simulation = Simulation::start_from(std::move(world));
  ObservableSeries series;
  for (int k = 0; k < ObservableSeries::kLagSamples + 3; ++k) {
    ASSERT_FALSE(simulation.advance_to(k * std::llround(ObservableSeries::kEvery / scene.dt)));
    series.sample(simulation);
  }
  ASSERT_EQ(series.values("msd").size(), 3u);
  for (const double square : series.values("msd")) {
    EXPECT_NEAR(square, std::pow(50 * ObservableSeries::kLag, 2), 1e-9) << "across the box's border too";
  }
}

TEST(Observables, TheErrorOfReplicasIsThatOfTheirMean) {
  const Estimate mean = mean_of_runs(std::vector<Estimate>{{1, 0.3}, {3, 0.4}});
  EXPECT_DOUBLE_EQ(mean.value, 2);
  EXPECT_DOUBLE_EQ(mean.sem, 0.25);
}

TEST(Continued, RodsAreWhereTheyWereAtAnyStep) {
  Simulation from = started(dilute());
  ASSERT_FALSE(from.advance_to(16 * 100));
  System coarse = dilute();
  coarse.dt = 64e-6;
  const Simulation simulation = continued(from, coarse);
  EXPECT_EQ(simulation.tick(), 100);
  const Snapshot before = from.snapshot();
  const Snapshot after = simulation.snapshot();
  for (std::size_t i = 0; i < before.n_rods(); ++i) {
    EXPECT_LT((after.position[i] - before.position[i]).norm(), 1e-12);
    EXPECT_LT((after.director[i] - before.director[i]).norm(), 1e-12);
    EXPECT_LT((after.velocity[i] - before.velocity[i]).norm(), 1e-9);
    EXPECT_LT((after.angular_velocity[i] - before.angular_velocity[i]).norm(), 1e-9);
    EXPECT_EQ(after.image[i], before.image[i]);
  }
}

}  // namespace
}  // namespace shaken::bench
