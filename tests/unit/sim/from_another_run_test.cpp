#include "sim/start/from_another_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/balance.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "tests/support/free_rods.h"

namespace shaken {
namespace {

System short_rods() { return test::scene_at(2.5, 0.4, 16, Start::kAligned); }

/// Rods of two species that have been shaken for `periods` vibrations of the plates.
Simulation shaken_for(double periods) {
  System system = short_rods();
  system.rod.n_beads = 7;
  system.added[0] = AddedRods{system.rod, 9};
  system.added[0]->rod.end_diameter = 0.5;
  Simulation simulation = std::move(Simulation::start(system)).value();
  const double ticks = periods / (system.frequency * system.dt);
  EXPECT_FALSE(simulation.advance_to(static_cast<Tick>(std::llround(ticks))));
  return simulation;
}

TEST(MakeWorld, FromAnotherKeepsWhereRodsAreAndHowTheyMove) {
  const Simulation before = shaken_for(10);
  System system = before.world().system;
  system.amplitude *= 1.5;
  system.dt *= 0.5;
  const auto made = make_world(system, before.world());
  ASSERT_TRUE(made) << made.error().message;
  const World& world = *made;
  EXPECT_EQ(world.tick, 0);
  EXPECT_EQ(world.shape_of_rod, before.world().shape_of_rod);
  const Snapshot then = before.snapshot();
  const Snapshot now = snapshot(world);
  for (std::size_t i = 0; i < now.n_rods(); ++i) {
    Vec3 moved = now.position[i] - then.position[i];
    for (const int x : {0, 1}) moved[x] -= system.box_side * std::round(moved[x] / system.box_side);
    // the base, which begins at the top of its travel, has risen by twice what the amplitude has grown
    EXPECT_NEAR((moved - Vec3(0, 0, 2 * (system.amplitude - before.world().system.amplitude))).norm(), 0, 1e-9);
    EXPECT_NEAR((now.velocity[i] - then.velocity[i]).norm(), 0, 1e-9);
    EXPECT_NEAR((now.director[i] - then.director[i]).norm(), 0, 1e-12);
    EXPECT_NEAR((now.angular_velocity[i] - then.angular_velocity[i]).norm(), 0, 1e-9);
  }
  const Content left = content(before.world());
  const double lifted = content(world).energy - left.energy;
  EXPECT_GT(lifted, 0);
  EXPECT_EQ(world.start.energy, content(world).energy) << "its budget begins with what it has";
}

TEST(MakeWorld, FromAnotherUnderTheSameConditionsGoesOnAsThatDoes) {
  Simulation one = shaken_for(10);
  Simulation other = std::move(Simulation::start(one.world().system, one.world())).value();
  const Tick ticks = 100;
  const std::int64_t hits_before = one.world().counters.impulses_rod_base;
  ASSERT_FALSE(one.advance_to(one.tick() + ticks));
  ASSERT_FALSE(other.advance_to(ticks));
  EXPECT_GT(one.world().counters.impulses_rod_base, hits_before) << "something happens meanwhile";
  EXPECT_EQ(other.world().counters.impulses_rod_base, one.world().counters.impulses_rod_base - hits_before);
  const Snapshot a = one.snapshot(), b = other.snapshot();
  for (std::size_t i = 0; i < a.n_rods(); ++i) {
    EXPECT_NEAR((a.director[i] - b.director[i]).norm(), 0, 1e-6) << i;
    EXPECT_NEAR(a.position[i].z(), b.position[i].z(), 1e-6) << i;
  }
}

TEST(MakeWorld, FromAnotherKeepsTheSpeciesOfEachRodWhateverTheSeed) {
  const Simulation before = shaken_for(1);
  System system = before.world().system;
  system.seed += 1;
  const World world = std::move(make_world(system, before.world())).value();
  EXPECT_NE(world.shape_of_rod, before.world().shape_of_rod);
  const auto heights = [](const World& of, std::uint8_t species) {
    std::vector<double> all;
    const Snapshot rods = snapshot(of);
    for (std::size_t i = 0; i < of.rods.size(); ++i) {
      if (of.shape_of_rod[i] == species) all.push_back(rods.position[i].z());
    }
    return all;
  };
  for (const std::uint8_t species : {0, 1}) {
    const auto now = heights(world, species), then = heights(before.world(), species);
    ASSERT_EQ(now.size(), then.size());
    for (std::size_t k = 0; k < now.size(); ++k) EXPECT_NEAR(now[k], then[k], 1e-9);
  }
}

TEST(MakeWorld, ReplicasFromOneStateGoTheirOwnWays) {
  System system = short_rods();
  Simulation alike = std::move(Simulation::start(system)).value();
  ASSERT_FALSE(alike.advance_to(12500));
  std::vector<Simulation> replicas;
  for (const std::uint64_t seed : {system.seed, system.seed + 1, system.seed + 2}) {
    system.seed = seed;
    replicas.push_back(std::move(Simulation::start(system, alike.world())).value());
    EXPECT_NEAR(replicas.back().world().start.energy / replicas.front().world().start.energy, 1, 1e-5);
    EXPECT_FALSE(replicas.back().advance_to(125000));  // half a second
  }
  const auto mean_angle = [&](std::size_t one, std::size_t other) {
    const Snapshot a = replicas[one].snapshot(), b = replicas[other].snapshot();
    double sum = 0;
    for (std::size_t i = 0; i < a.n_rods(); ++i)
      sum += std::asin(std::min(1.0, a.director[i].cross(b.director[i]).norm()));
    return sum / static_cast<double>(a.n_rods());
  };
  for (const auto& [one, other] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
    EXPECT_GT(mean_angle(one, other), 0.1) << one << " and " << other;
  }
}

TEST(MakeWorld, FromAnotherThatDoesNotFitIsRefused) {
  const auto refusal = [](const World& left, const System& system) {
    const auto world = make_world(system, left);
    return world ? std::string() : world.error().message;
  };
  const Simulation before = shaken_for(2);
  System system = before.world().system;
  system.gap += 0.1;
  system.rod.length += 0.1;
  system.lid = false;
  EXPECT_EQ(refusal(before.world(), system),
            "not the same as where the rods come from: the rods, the plates that are there")
      << "another gap would do";
  system = before.world().system;
  system.walls = SideWalls{};
  EXPECT_EQ(refusal(before.world(), system), "not the same as where the rods come from: the walls");
  const Simulation half = shaken_for(2.25);
  EXPECT_EQ(refusal(half.world(), half.world().system),
            "its plates are in the middle of a vibration at 0.011252 s and would jump; the nearest whole one is at "
            "0.01 s");
}

// 200 and 300 Hz come together after each 10 ms. Of plates that only the second moves, its periods alone count.
TEST(OffTheBeat, CountsEveryVibrationThatIsThere) {
  System system;
  system.dt = 5e-6;  // 1,000 ticks of the first
  system.frequency = 200;
  EXPECT_EQ(off_the_beat(system, 1000), 0);
  system.second = SecondVibration{0.01, 300, 20};
  EXPECT_NEAR(std::abs(off_the_beat(system, 1000)), 5.0 / 3000, 1e-12);
  EXPECT_NEAR(off_the_beat(system, 2000), 0, 1e-12);
  EXPECT_EQ(nearest_beat(system, 1000), "both vibrations, of 200 and 300 Hz, must be whole ones there");
  system.amplitude = 0;
  system.second->frequency = 500;
  EXPECT_NEAR(off_the_beat(system, 400), 0, 1e-12);
  EXPECT_NEAR(off_the_beat(system, 500), 5e-4, 1e-12);
}

// A lid that is lower at the start of the next run might be in rods.
TEST(StartMismatch, IsOfLidsThatMoveInOtherWays) {
  System system;
  system.lid_motion = LidMotion{0.02, 30};
  System other = system;
  EXPECT_EQ(start_mismatch(system, other), "");
  other.lid_motion->phase = 40;
  EXPECT_EQ(start_mismatch(system, other), "how the lid moves");
  other = system;
  other.amplitude *= 2;
  EXPECT_EQ(start_mismatch(system, other), "how the lid moves");
  other.lid_motion.reset();
  EXPECT_EQ(start_mismatch(system, other), "how the lid moves");
  System plain, stronger;
  stronger.amplitude *= 2;
  EXPECT_EQ(start_mismatch(plain, stronger), "") << "a lid that moves with the base keeps its height over it";
}

}  // namespace
}  // namespace shaken
