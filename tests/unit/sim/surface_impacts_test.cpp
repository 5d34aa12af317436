#include "sim/tick/surface_impacts.h"

#include <gtest/gtest.h>

#include "sim/start/initial.h"

namespace shaken {
namespace {

// A sphere in a gap that leaves it 0.02 mm. It is 0.028 mm deep in the base, which it met within this tick, so it has
// bounced off since and would be 0.008 mm deep in the lid: that is a hit of the same tick.
TEST(SurfaceImpacts, ARodThatTheBaseDisplacesMeetsTheLidInTheSameTick) {
  System system;
  system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  system.n_rods = 1;
  system.box_side = 20;
  system.gap = 0.82;
  system.amplitude = 0;
  system.gravity = 0;
  system.dt = 64e-6;
  system.impacts = ImpactTime::kAtInstant;
  system.rod_base = system.rod_lid = {0, 1};
  const World world = empty_world(system);
  const TickRules rules(world);
  const PlateState plates = world.plates.at(0);
  constexpr double kSpeed = 500;
  Flight flight;
  flight.position = {10, 10, plates.base + 0.4 - 0.028};
  flight.velocity = {0, 0, -kSpeed};
  flight.prepare();
  RodAtTick rod = rod_at_tick(flight, 0, rules);
  Counters counters;

  ASSERT_FALSE(meet_surfaces(0, rod, flight, plates, 0, rules, counters).has_value());

  EXPECT_EQ(counters.impulses_rod_base, 1);
  EXPECT_EQ(counters.impulses_rod_lid, 1);
  EXPECT_NEAR(rod.motion.velocity.z(), -kSpeed, 1e-9);
  EXPECT_NEAR(rod.pose.position.z(), plates.lid - 0.4 - 0.008, 1e-9);
}

// All beads of a level cylinder are equally deep. Those that are seen first must not depend on which end is the first.
TEST(SurfaceImpacts, ALevelRodMeetsTheBaseTheSameWayTurnedEndForEnd) {
  System system;
  system.rod = {.length = 3, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 5};
  system.n_rods = 1;
  system.box_side = 20;
  system.amplitude = 0;
  system.rod_base = {0.3, 0.5};
  const World world = empty_world(system);
  const TickRules rules(world);
  const PlateState plates = world.plates.at(0);
  const auto motion_after = [&](const Vec3& director) {
    Flight flight;
    flight.position = {10, 10, plates.base + 0.4 - 0.001};
    flight.velocity = {20, 7, -30};
    flight.director = director;
    flight.precession = {0, 0, 5};
    flight.prepare();
    RodAtTick rod = rod_at_tick(flight, 0, rules);
    Counters counters;
    EXPECT_FALSE(meet_surfaces(0, rod, flight, plates, 0, rules, counters).has_value());
    EXPECT_GT(counters.impulses_rod_base, 1);
    return rod.motion;
  };
  const Motion one = motion_after({0.6, 0.8, 0}), other = motion_after({-0.6, -0.8, 0});
  EXPECT_EQ(one.velocity, other.velocity);
  EXPECT_EQ(one.angular_velocity, other.angular_velocity);
}

}  // namespace
}  // namespace shaken
