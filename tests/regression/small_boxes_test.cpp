// No collision is missed in boxes so small that rods are near two images of one another: both steppers give the same,
// and what they give is a gas of bodies that never pass through each other.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/simulation.h"
#include "tests/support/compare_steppers.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace small_boxes_test {

using test::compare;
using test::problem;

/// Bodies that fly about in the plane and lose nothing: no plates, whose hits would have every bound renewed soon.
System planar_scene(const RodShape& rod, int n_rods, double box_side, double dt) {
  System system;
  system.rod = rod;
  system.n_rods = n_rods;
  system.box_side = box_side;
  system.base = system.lid = false;
  system.gravity = 0;
  system.rod_rod = {0.0, 1.0};
  system.dt = dt;
  return system;
}

Flight flight_of(const Vec3& position, const Vec3& director, const Vec3& velocity, double turning = 0) {
  Flight flight;
  flight.position = position;
  flight.director = director;
  flight.velocity = velocity;
  flight.precession = {0, 0, turning};
  flight.prepare();
  return flight;
}

/// Ticks of `seconds`.
Tick ticks_of(const System& system, double seconds) { return static_cast<Tick>(std::round(seconds / system.dt)); }

const RodShape kRod{.length = 2.5, .n_beads = 9};
const RodShape kSphere{.length = 0.8, .n_beads = 1};
const RodShape kPin{.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}};

/// Two rods in a row drift apart: through the border they meet.
World drifting_apart(double boxes, double dt) {
  const System system = planar_scene(kRod, 2, boxes * kRod.length, dt);
  World world = empty_world(system);
  const double middle = 0.5 * system.box_side;
  world.rods = {flight_of({middle - 1.3, middle, 0.6}, Vec3::UnitX(), {-15, 0, 0}),
                flight_of({middle + 1.3, middle, 0.6}, Vec3::UnitX(), {15, 0, 0})};
  return world;
}

TEST(SmallBoxes, RodsThatDriftApartMeetTheNextImage) {
  for (const double dt : {4e-6, 16e-6}) {
    for (double boxes = 2.2; boxes < 3.0; boxes += 0.05) {
      World world = drifting_apart(boxes, dt);
      const Tick ticks = ticks_of(world.system, 0.5);
      EXPECT_EQ(problem(compare(world, ticks, ticks / 3)), "") << boxes << " rod lengths, " << dt;
      // to and fro between the two images: a contact each time that they have flown what the box leaves free
      Simulation simulation = Simulation::start_from(world);
      ASSERT_FALSE(simulation.advance_to(ticks).has_value());
      const double free = world.system.box_side - 2 * kRod.length;
      const double path = 30 * 0.5 - (free - 0.1);  // relative to each other, from the first contact on
      EXPECT_NEAR(static_cast<double>(simulation.world().counters.impulses_rod_rod), 1 + std::floor(path / free), 1)
          << boxes << " rod lengths, " << dt;
      EXPECT_LT(simulation.world().counters.max_overlap_rod_rod, 2 * 30 * dt);
    }
  }
}

TEST(SmallBoxes, TwoShakenSpheres) {
  for (const double side : {1.76, 1.84, 2.0, 2.4}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      System system;
      system.rod = kSphere;
      system.n_rods = 2;
      system.box_side = side;
      system.seed = seed;
      EXPECT_EQ(problem(compare(system, 120000, 30000)), "") << side << " mm, seed " << seed;
    }
  }
}

struct Case {
  const char* name;
  const RodShape* rod;
  int n_rods;

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

class SmallBoxesOf : public testing::TestWithParam<Case> {};

/// From the narrowest box there may be to three times the bodies' length.
TEST_P(SmallBoxesOf, BothSteppersAgreeAndNothingPassesThroughAnything) {
  const auto& [name, rod, n_rods] = GetParam();
  const Species species = make_species(*rod);
  const double least = least_box_side(std::span(&species, 1));
  const double length = 2 * species.reach();
  int n_impulses = 0;
  for (const double dt : {4e-6, 16e-6}) {
    for (int k = 0; k < 16; ++k) {
      System system = planar_scene(*rod, n_rods, least + (3 * length - least) * k / 15, dt);
      system.start = Start::kRandom;
      system.seed = static_cast<std::uint64_t>(k + 1);
      constexpr Tick ticks = 75000;
      EXPECT_EQ(problem(compare(system, ticks, ticks / 3)), "") << system.box_side << " mm, " << dt;
      auto simulation = Simulation::start(system);
      ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
      ASSERT_FALSE(simulation->advance_to(ticks).has_value());
      n_impulses += static_cast<int>(simulation->world().counters.impulses_rod_rod);
      EXPECT_LT(simulation->world().counters.max_overlap_rod_rod, 0.2e3 * dt) << system.box_side << " mm, " << dt;
    }
  }
  EXPECT_GT(n_impulses, 50);
}

INSTANTIATE_TEST_SUITE_P(Bodies, SmallBoxesOf,
                         testing::Values(Case{"TwoRods", &kRod, 2}, Case{"FourRods", &kRod, 4},
                                         Case{"TwoSpheres", &kSphere, 2}, Case{"ThreeSpheres", &kSphere, 3},
                                         Case{"TwoPins", &kPin, 2}),
                         [](const auto& about) { return std::string(about.param.name); });

// On a steep slope rods become faster while nothing hits them, and friction with the plates tells them apart.
TEST(SmallBoxes, RodsThatSlideDownASlope) {
  for (const double inclination : {20.0, 60.0}) {
    for (int k = 0; k < 24; ++k) {
      System system;
      system.rod = kRod;
      system.n_rods = 3;
      system.box_side = 2.2 * kRod.length * (1 + 0.05 * k);
      system.start = Start::kRandom;
      system.inclination = inclination;
      system.inclination_angle = 15.0 * k;
      system.amplitude = 0.005;
      system.rod_base.friction = 0.5;
      system.rod_lid.friction = 0;
      system.seed = static_cast<std::uint64_t>(k + 1);
      EXPECT_EQ(problem(compare(system, 60000, 20000)), "") << inclination << " degrees, case " << k;
    }
  }
}

TEST(SmallBoxes, BelowTheLeastNoRunStarts) {
  for (const RodShape* rod : {&kRod, &kSphere, &kPin}) {
    const Species species = make_species(*rod);
    const double least = least_box_side(std::span(&species, 1));
    EXPECT_GE(least, 2.2 * rod->length * (1 - 1e-9));
    EXPECT_TRUE(static_cast<bool>(Simulation::start(planar_scene(*rod, 2, least, 4e-6))));
    const auto started = Simulation::start(planar_scene(*rod, 2, 0.99 * least, 4e-6));
    ASSERT_FALSE(static_cast<bool>(started));
    EXPECT_NE(started.error().message.find("too small"), std::string::npos) << started.error().message;
  }
}

}  // namespace small_boxes_test
}  // namespace shaken
