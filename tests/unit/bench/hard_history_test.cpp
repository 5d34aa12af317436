// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "base/failure.h"
#include "bench/case.h"
#include "bench/hard/hard.h"
#include "sim/balance.h"

namespace shaken::bench {
namespace {

System a_few_rods() {
  System scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.box_side = 10;
  scene.n_rods = 5;
  scene.start = Start::kRandom;
  scene.dt = 20e-6;
  return scene;
}

TEST(HardHistory, IsThatOfTheRun) {
  constexpr double kSeconds = 0.4;
  const std::vector<HistoryPoint> history = history_of(a_few_rods(), kSeconds, [](double) {});
  ASSERT_EQ(history.size(), static_cast<std::size_t>(kHistoryPoints));
  auto simulation = Simulation::start(a_few_rods());
  ASSERT_TRUE(static_cast<bool>(simulation));
  for (std::size_t k = 0; k < history.size(); ++k) {
    ASSERT_FALSE(simulation->advance_to(100 * static_cast<Tick>(k + 1)));
    const World& world = simulation->world();
    EXPECT_NEAR(history[k].time, 2e-3 * static_cast<double>(k + 1), 1e-12);
    EXPECT_EQ(history[k].overlap, world.counters.max_overlap() / thinnest_radius(world)) << "the deepest so far";
    EXPECT_EQ(history[k].energy_error, balance(world).energy_error());
    EXPECT_GT(history[k].kinetic_energy, 0);
    EXPECT_GT(history[k].order, 0);
    EXPECT_LE(history[k].order, 1);
  }
}

TEST(HardHistory, OfRodsInFreeFlightIsFlat) {
  System scene = a_few_rods();
  scene.n_rods = 1;
  scene.gravity = scene.amplitude = 0;
  scene.base = scene.lid = false;
  const std::vector<HistoryPoint> history = history_of(scene, 0.1, [](double) {});
  for (const HistoryPoint& point : history) {
    EXPECT_NEAR(point.kinetic_energy, history.front().kinetic_energy, 1e-9 * point.kinetic_energy);
    EXPECT_NEAR(point.order, 1, 1e-12) << "one rod is parallel to itself";
    EXPECT_EQ(point.overlap, 0);
  }
}

TEST(HardHistory, TroubleIsAFailure) {
  System scene = a_few_rods();
  scene.amplitude *= 100;
  scene.dt = 1e-4;
  EXPECT_THROW(history_of(scene, 10, [](double) {}), Failure);
}

}  // namespace
}  // namespace shaken::bench
