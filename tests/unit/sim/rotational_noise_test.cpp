// One kick of a rough plate, exactly; what many do to a rod is tests/physics/rotational_noise_test.cpp.
#include "sim/tick/rotational_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/simulation.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

constexpr double kNoise = 0.03;  // [rad/mm]

TickRules rules_of(std::uint64_t seed) {
  System system;
  system.n_rods = 1;
  system.rotational_noise = kNoise;
  system.seed = seed;
  return TickRules(empty_world(system));
}

RodAtTick rod_at(const Vec3& director) {
  RodAtTick rod{};
  rod.pose = {Vec3(1, 2, 0.6), director.normalized()};
  rod.motion = {Vec3(30, -20, 10), Vec3(7, -5, 11)};
  rod.has_motion = true;
  return rod;
}

/// +1 or -1: to which side this hit turns a rod that lies flat.
double side_of(int index, int hit, Tick now, const TickRules& rules) {
  RodAtTick rod = rod_at(Vec3::UnitX());
  const double before = rod.motion.angular_velocity.z();
  Counters counters;
  turn_at_random(index, hit, rod, rules.species[0], 1.0 / kNoise, now, rules, counters);
  return rod.motion.angular_velocity.z() - before;
}

TEST(RotationalNoise, AKickIsNoiseTimesSpeedInAngularVelocityAboutTheVerticalLessWhatLiesAlongTheRod) {
  const TickRules rules = rules_of(1);
  const SpeciesMechanics& kind = rules.species[0];
  int n_left = 0, n = 0;
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(1, 2, 0.4), Vec3(-3, 1, -1), Vec3(0.2, 0.1, 1), Vec3(0, 0, 1)}) {
    for (const double speed : {0.0, 1e-3, 55.0, 400.0}) {
      for (Tick now = 1; now <= 50; ++now, ++n) {
        RodAtTick rod = rod_at(along);
        const RodAtTick before = rod;
        Counters counters;
        turn_at_random(3, 1, rod, kind, speed, now, rules, counters);
        const Vec3& n_ = rod.pose.director;
        const Vec3 kick = rod.motion.angular_velocity - before.motion.angular_velocity;
        const Vec3 to_one_side = kNoise * speed * (Vec3::UnitZ() - n_.z() * n_);
        const double off = std::min((kick - to_one_side).norm(), (kick + to_one_side).norm());
        EXPECT_LT(off, 1e-14 * (1 + speed)) << along.transpose() << ", " << speed;
        EXPECT_NEAR(kick.dot(n_), 0, 1e-14 * (1 + speed)) << "no spin about the rod";
        n_left += kick.z() > 0;
        // nothing but the turning has changed, and the budget has what it took
        EXPECT_EQ(rod.motion.velocity, before.motion.velocity);
        EXPECT_EQ(rod.pose.director, before.pose.director);
        EXPECT_TRUE(rod.changed);
        EXPECT_EQ(counters.noise_kicks, 1);
        const auto energy = [&](const Vec3& w) {
          const double spin = w.dot(n_);
          return 0.5 * kind.inertia_perp * (w.squaredNorm() - spin * spin) + 0.5 * kind.inertia_par * spin * spin;
        };
        EXPECT_NEAR(counters.ledger.noise.value(),
                    energy(rod.motion.angular_velocity) - energy(before.motion.angular_velocity),
                    1e-9 * (1 + energy(rod.motion.angular_velocity)));
      }
    }
  }
  EXPECT_GT(n_left, n / 4);
}

// 3.8 million keys, of which each mean is known to its own 1 / sqrt(n): bounds of four and a half errors.
TEST(RotationalNoise, SidesAreDrawnEquallyOftenAndAnewForEverySeedRodTickAndHit) {
  constexpr int kIndices = 240, kTicks = 2000, kHits = 2;
  double sum = 0, next_tick = 0, next_rod = 0, next_hit = 0, next_seed = 0;
  for (const std::uint64_t seed : {1, 7}) {
    const TickRules rules = rules_of(seed), of_next_seed = rules_of(seed + 1);
    for (int index = 0; index < kIndices; ++index) {
      for (Tick now = 0; now < kTicks; ++now) {
        for (int hit = 0; hit < kHits; ++hit) {
          const double side = side_of(index, hit, now, rules);
          ASSERT_NEAR(std::abs(side), 1, 1e-12);
          sum += side;
          if (now % 10 != 0) continue;
          next_tick += side * side_of(index, hit, now + 1, rules);
          next_rod += side * side_of(index + 1, hit, now, rules);
          next_hit += side * side_of(index, hit + 1, now, rules);
          next_seed += side * side_of(index, hit, now, of_next_seed);
        }
      }
    }
  }
  const double n = 2.0 * kIndices * kTicks * kHits;
  EXPECT_LT(std::abs(sum), 4.5 * std::sqrt(n)) << sum / n;
  for (const double product : {next_tick, next_rod, next_hit, next_seed}) {
    // a hit and the next one come twice each: the variance is at most doubled
    EXPECT_LT(std::abs(product), 4.5 * std::sqrt(2 * n / 10)) << product / (n / 10);
  }
}

// Shapes are counted through all sizes of all species that are there; noise is of the scene's species.
TEST(RotationalNoise, IsThatOfTheSpeciesWhateverItsSizes) {
  System system = test::short_rods(20, 30);
  system.rod.spread.length = 0.1;
  system.added[1] = AddedRods{{.length = 2.0, .n_beads = 7, .spread = {.length = 0.1}}, 10};
  system.rotational_noise = 0.03;
  system.added_noise = {0.5, 0.07};  // the first of them of rods that are not there
  const World world = empty_world(system);
  const TickRules rules(world);
  const Cell cell = world.cell();
  EXPECT_GT(rules.species.size(), 4u);
  for (int i = 0; i < system.n_all_rods(); ++i) {
    const bool is_third = cell.species_of(static_cast<std::size_t>(i)) == 1;
    EXPECT_EQ(rules.species_of(i).rotational_noise, is_third ? 0.07 : 0.03) << i;
    RodAtTick rod = rod_at(Vec3::UnitX());
    const double before = rod.motion.angular_velocity.z();
    Counters counters;
    turn_at_random(i, 0, rod, rules.species_of(i), 10.0, 5, rules, counters);
    EXPECT_NEAR(std::abs(rod.motion.angular_velocity.z() - before), is_third ? 0.7 : 0.3, 1e-13);
  }
}

// Between plates without friction nothing but noise changes the angular momentum about the vertical of a rod that meets
// no other.
TEST(RotationalNoise, KicksOnlyRodsOfSpeciesThatHaveIt) {
  for (const bool of_added : {false, true}) {
    System system = test::short_rods(3, 100);
    system.added[0] = AddedRods{system.rod, 3};
    system.start = Start::kRandom;
    system.rod_base.friction = system.rod_lid.friction = 0;
    system.rotational_noise = of_added ? 0 : 0.05;
    system.added_noise[0] = of_added ? 0.05 : 0;
    auto simulation = Simulation::start(system);
    ASSERT_TRUE(static_cast<bool>(simulation));
    std::vector<double> before;
    for (const Flight& rod : simulation->world().rods) before.push_back(rod.precession.z());
    ASSERT_FALSE(simulation->advance_to(10000).has_value());
    const World& world = simulation->world();
    ASSERT_EQ(world.counters.impulses_rod_rod, 0);
    const std::int64_t hits = world.counters.impulses_rod_base + world.counters.impulses_rod_lid;
    EXPECT_GT(world.counters.noise_kicks, 0);
    EXPECT_LT(world.counters.noise_kicks, hits) << "rods without noise count none";
    const Cell cell = world.cell();
    for (std::size_t i = 0; i < world.rods.size(); ++i) {
      const double change = std::abs(world.rods[i].precession.z() - before[i]);
      const bool is_kicked = (cell.species_of(i) == 1) == of_added;
      EXPECT_TRUE(is_kicked ? change > 1e-3 : change < 1e-9) << i << ": " << change;
    }
  }
}

// One number in `plates.noise` is the same as that number for each species.
TEST(RotationalNoise, OfEachSpeciesAlikeIsThatOfAll) {
  System common = test::short_rods(20, 20);
  common.added[0] = AddedRods{{.length = 2.5, .n_beads = 9, .profile = Profile::kPolar}, 10};
  common.rotational_noise = 0.05;
  System each = common;
  each.added_noise[0] = 0.05;
  System other = common;
  other.added_noise[0] = 0.051;
  const auto hash = [](const System& system) {
    auto simulation = Simulation::start(system);
    EXPECT_FALSE(simulation->advance_to(3000).has_value());
    return simulation->state_hash();
  };
  EXPECT_EQ(hash(common), hash(each));
  EXPECT_NE(hash(common), hash(other));
}

TEST(RotationalNoise, TheSideDependsOnTheKeyOnly) {
  const TickRules rules = rules_of(1);
  for (Tick now = 0; now < 200; ++now) {
    RodAtTick rod = rod_at(Vec3(1, 1, 0.3));
    rod.motion.angular_velocity.z() = -40;
    Counters counters;
    turn_at_random(5, 0, rod, rules.species[0], 123.0, now, rules, counters);
    EXPECT_EQ(rod.motion.angular_velocity.z() > -40, side_of(5, 0, now, rules) > 0) << now;
  }
}

}  // namespace
}  // namespace shaken
