// SPDX-License-Identifier: MIT
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

}  // namespace
}  // namespace shaken
