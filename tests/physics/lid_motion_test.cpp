// A lid that does not move with the base, against what one impact on it does.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulation.h"

namespace shaken {
namespace {

/// The velocity with which a weightless sphere leaves the lid that it flies at, and when [mm/s, s].
struct Bounce {
  double velocity, time;
};
Bounce bounce_off_lid(const System& system, double height, double speed) {
  World world = empty_world(system);
  Flight flight;
  flight.position = {10, 10, height};
  flight.velocity = {0, 0, speed};
  flight.prepare();
  world.rods = {flight};
  Simulation simulation = Simulation::start_from(world);
  for (Tick k = 1; k < 100000; ++k) {
    EXPECT_FALSE(simulation.advance_to(k).has_value());
    if (simulation.world().counters.impulses_rod_lid > 0)
      return {simulation.snapshot().velocity[0].z(), static_cast<double>(k) * system.dt};
  }
  return {NAN, NAN};
}

System sphere_below_lid() {
  System system;
  system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  system.n_rods = 1;
  system.box_side = 20;
  system.gap = 3;
  system.gravity = 0;
  system.base = false;
  system.rod_lid = {0.0, 0.6};
  return system;
}

TEST(LidMotion, ALidAtRestReflectsWithItsRestitution) {
  System system = sphere_below_lid();
  system.lid_motion = LidMotion{};
  const Bounce bounce = bounce_off_lid(system, 1.0, 50);
  EXPECT_DOUBLE_EQ(bounce.velocity, -0.6 * 50);
  EXPECT_NEAR(bounce.time, (system.amplitude + system.gap - 0.4 - 1.0) / 50, system.dt);
}

// Off a lid that moves with V: v' = (1 + e) V - e v.
TEST(LidMotion, AMovingLidAddsItsVelocity) {
  for (const double phase : {0.0, 90.0, 200.0}) {
    System system = sphere_below_lid();
    system.lid_motion = LidMotion{0.05, phase};
    const double omega = 2 * kPi * system.frequency;
    const Bounce bounce = bounce_off_lid(system, 1.0, 400);
    const double lid = -0.05 * omega * std::sin(omega * bounce.time + phase * kPi / 180);
    EXPECT_NEAR(bounce.velocity, 1.6 * lid - 0.6 * 400, 1e-9) << phase;
  }
}

// The base alone moves where the lid rests: the gap between them is widest where the base is lowest.
TEST(LidMotion, RodsStartBetweenThePlatesAsTheyAreThen) {
  System system;
  system.n_rods = 200;
  system.box_side = 40;
  system.gap = 1.2;
  system.amplitude = 0.15;
  system.frequency = 60;
  system.lid_motion = LidMotion{};
  for (const Start start : {Start::kAligned, Start::kCompressed}) {
    system.start = start;
    auto simulation = Simulation::start(system);
    ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
    const PlateState plates = simulation->world().plates.at(0);
    EXPECT_NEAR(plates.lid - plates.base, 1.2 - 0.15, 1e-12);
    for (const Vec3& place : simulation->snapshot().position) {
      EXPECT_GT(place.z() - 0.4, plates.base);
      EXPECT_LT(place.z() + 0.4, plates.lid);
    }
    ASSERT_FALSE(simulation->advance_to(3000).has_value());
    EXPECT_LT(simulation->world().counters.max_overlap_rod_surface, 0.01);
  }
}

}  // namespace
}  // namespace shaken
