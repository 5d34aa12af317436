// Bodies on inclined plates at rest: what slides, rolls or falls down a slope does so as in any textbook of mechanics.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/balance.h"
#include "sim/simulation.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

constexpr double kDegree = kPi / 180;

/// A sphere that lies on an inclined base at rest.
Simulation sphere_on_slope(System& system) {
  system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  system.n_rods = 1;
  system.box_side = 20;
  system.amplitude = 0;
  system.rod_base.restitution = 0;
  World world = empty_world(system);
  Flight flight;
  flight.position = {10, 10, 0.4};
  flight.prepare();
  world.rods = {flight};
  return Simulation::start_from(world);
}

/// Its velocity down the slope and across it, and the rate at which it spins about the axis of rolling.
struct Descent {
  double down, across, spin;
};
Descent descent(const System& system, const Simulation& simulation) {
  const Vec2 way(std::cos(system.inclination_angle * kDegree), std::sin(system.inclination_angle * kDegree));
  const Snapshot now = simulation.snapshot();
  const Vec2 v = now.velocity[0].head<2>();
  const Vec2 w = now.angular_velocity[0].head<2>();
  return {v.dot(way), v.x() * way.y() - v.y() * way.x(), w.y() * way.x() - w.x() * way.y()};
}

// A solid sphere rolls with 5/7 of g sin(alpha) where friction is enough for that, tan(alpha) <= 7/2 mu.
TEST(Inclination, ASphereRollsDownTheSlope) {
  for (const double angle : {0.0, 60.0, -135.0}) {
    System system;
    system.inclination = 10;
    system.inclination_angle = angle;
    system.rod_base.friction = 0.3;
    Simulation simulation = sphere_on_slope(system);
    const double expected = 5.0 / 7 * system.gravity * std::sin(10 * kDegree);
    ASSERT_FALSE(simulation.advance_to(2500).has_value());
    const Descent first = descent(system, simulation);
    ASSERT_FALSE(simulation.advance_to(12500).has_value());
    const Descent then = descent(system, simulation);
    const double time = 10000 * system.dt;
    EXPECT_NEAR((then.down - first.down) / time / expected, 1, 2e-3) << angle;
    EXPECT_NEAR(then.down / (0.4 * then.spin), 1, 2e-3);
    EXPECT_NEAR(then.across, 0, 1e-6 * then.down);
  }
}

// Where it is not, it slides with g (sin(alpha) - mu cos(alpha)), and 5/2 mu g cos(alpha) / r turns it.
TEST(Inclination, ASphereSlidesDownASteepSlope) {
  for (const double mu : {0.0, 0.05, 0.1}) {
    System system;
    system.inclination = 40;
    system.rod_base.friction = mu;
    Simulation simulation = sphere_on_slope(system);
    ASSERT_FALSE(simulation.advance_to(5000).has_value());
    const Descent then = descent(system, simulation);
    const double time = 5000 * system.dt;
    const double sin = std::sin(40 * kDegree), cos = std::cos(40 * kDegree);
    EXPECT_NEAR(then.down / time / (system.gravity * (sin - mu * cos)), 1, 2e-3) << mu;
    EXPECT_NEAR(then.spin / time, 2.5 * mu * system.gravity * cos / 0.4, 2e-3 * 2.5 * system.gravity / 0.4) << mu;
  }
}

// Without friction nothing but gravity acts along the plates, whatever the rods do to each other.
TEST(Inclination, RodsWithoutPlateFrictionFallFreelyDownTheSlope) {
  System system = test::short_rods(60);
  system.inclination = 1.5;
  system.inclination_angle = 30;
  system.rod_base.friction = system.rod_lid.friction = 0;
  auto simulation = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(simulation));
  const auto mean = [&] {
    Vec2 sum = Vec2::Zero();
    for (const Vec3& v : simulation->snapshot().velocity) sum += v.head<2>() / 60;
    return sum;
  };
  const Vec2 before = mean();
  ASSERT_FALSE(simulation->advance_to(10000).has_value());
  const double fall = system.gravity * std::sin(1.5 * kDegree) * 10000 * system.dt;
  const Vec2 expected(fall * std::cos(30 * kDegree), fall * std::sin(30 * kDegree));
  EXPECT_LT((mean() - before - expected).norm(), 1e-9 * fall);
  EXPECT_GT(simulation->world().counters.impulses_rod_rod, 200);
  EXPECT_LT(balance(simulation->world()).energy_error(), 1e-11);
}

// Across the plates there is only g cos(alpha): on a vertical plate a sphere does not touch it any more.
TEST(Inclination, NothingPressesABodyOnAVerticalPlate) {
  System system;
  system.inclination = 90;
  system.rod_base.friction = 0.5;
  Simulation simulation = sphere_on_slope(system);
  ASSERT_FALSE(simulation.advance_to(5000).has_value());
  EXPECT_NEAR(descent(system, simulation).down, system.gravity * 5000 * system.dt, 1e-6);
  EXPECT_NEAR(descent(system, simulation).spin, 0, 1e-9);
}

}  // namespace
}  // namespace shaken
