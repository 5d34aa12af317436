// Plates that vibrate in the plane carry bodies by friction alone, and plates at rest stop them by it.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulation.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

/// A sphere that lies on a base that moves in the plane only, with `share` of gravity as its largest
/// acceleration.
Simulation sphere_at_rest(System& system, double share, double restitution = 0, const Vec3& velocity = Vec3::Zero()) {
  system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  system.n_rods = 1;
  system.box_side = 20;
  system.amplitude = 0;
  system.frequency = 50;
  system.horizontal_amplitude = share * system.gravity / std::pow(2 * kPi * system.frequency, 2);
  system.rod_base.restitution = restitution;
  World world = empty_world(system);
  Flight flight;
  flight.position = {10, 10, 0.4};
  flight.velocity = velocity;
  flight.prepare();
  world.rods = {flight};
  return Simulation::start_from(world);
}

/// Velocity of the plate along its direction, worked out here.
double slide_at(const System& system, double time) {
  const double omega = 2 * kPi * system.frequency;
  return -system.horizontal_amplitude * omega * std::sin(omega * time + system.horizontal_phase * kPi / 180);
}
Vec2 direction_of(const System& system) {
  const double angle = system.horizontal_angle * kPi / 180;
  return {std::cos(angle), std::sin(angle)};
}

// The force F at the foot of a solid sphere gives m v' = F and (2/5) m r^2 w' = F r; without slip v + w r is the
// plate's velocity, so v' is 2/7 of the plate's acceleration.
TEST(HorizontalVibration, ASphereThatRollsGetsTwoSeventhsOfThePlatesVelocity) {
  for (const double phase : {0.0, 90.0, -37.0}) {
    for (const double angle : {0.0, 30.0, 200.0}) {
      System system;
      system.horizontal_phase = phase;
      system.horizontal_angle = angle;
      system.rod_base.friction = 0.5;
      Simulation simulation = sphere_at_rest(system, 0.3);
      const double fastest = 2 * kPi * system.frequency * system.horizontal_amplitude;
      const Vec2 along = direction_of(system);
      Vec2 first = Vec2::Zero();
      for (int k = 1; k <= 40; ++k) {
        ASSERT_FALSE(simulation.advance_to(2500 + k * 250).has_value());
        const Vec2 velocity = simulation.snapshot().velocity[0].head<2>();
        const Vec2 rest = velocity - 2.0 / 7 * slide_at(system, simulation.time()) * along;
        if (k == 1) first = rest;
        EXPECT_LT((rest - first).norm(), 1e-3 * fastest) << "phase " << phase << ", angle " << angle;
      }
    }
  }
}

// Coulomb's friction is mu m g whichever way the plate slides: a plate that is much faster than the sphere pushes it
// half a period to one side and half a period to the other.
TEST(HorizontalVibration, APlateThatSlipsPushesBySlidingFriction) {
  System system;
  system.horizontal_angle = -70;
  system.rod_base.friction = 0.01;
  Simulation simulation = sphere_at_rest(system, 5);
  double least = 1e9, most = -1e9;
  for (int k = 0; k < 200; ++k) {
    ASSERT_FALSE(simulation.advance_to(50000 + k * 50).has_value());  // two periods
    const double v = simulation.snapshot().velocity[0].head<2>().dot(direction_of(system));
    least = std::min(least, v);
    most = std::max(most, v);
  }
  const double expected = system.rod_base.friction * system.gravity / (2 * system.frequency);
  EXPECT_NEAR(most - least, expected, 0.02 * expected);
}

// A base at rest stops a sphere that slides by mu g, whatever the restitution, until it rolls at 5/7 of its speed.
TEST(RodsAtRest, ASphereThatSlidesOnAPlateAtRestIsStoppedByMuG) {
  for (const double restitution : {0.0, 0.3, 0.8}) {
    for (const ImpulseLaw law : {ImpulseLaw::kNewton, ImpulseLaw::kPoisson, ImpulseLaw::kEnergetic}) {
      System system;
      system.law = law;
      system.rod_base.friction = 0.05;
      Simulation simulation = sphere_at_rest(system, 0, restitution, {100, 0, 0});
      ASSERT_FALSE(simulation.advance_to(10000).has_value());
      const double expected = 100 - system.rod_base.friction * system.gravity * simulation.time();
      EXPECT_NEAR(simulation.snapshot().velocity[0].x(), expected, 1) << "restitution " << restitution;
    }
  }
}

TEST(HorizontalVibration, DoesNothingWithoutFriction) {
  System system = test::short_rods(40);
  system.rod_base.friction = system.rod_lid.friction = 0;
  auto still = Simulation::start(system);
  system.horizontal_amplitude = 0.1;
  auto sliding = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(still) && static_cast<bool>(sliding));
  for (const Tick k : {1000, 10000}) {
    ASSERT_FALSE(still->advance_to(k).has_value());
    ASSERT_FALSE(sliding->advance_to(k).has_value());
    EXPECT_EQ(still->state_hash(), sliding->state_hash()) << "tick " << k;
  }
}

/// Mean velocity of 60 rods over 1 s [mm/s].
Vec2 mean_drift(double phase, double angle) {
  System system = test::short_rods(60);
  system.dt = 16e-6;
  system.rod_base.friction = system.rod_lid.friction = 0.3;
  system.horizontal_amplitude = system.amplitude;
  system.horizontal_phase = phase;
  system.horizontal_angle = angle;
  auto simulation = Simulation::start(system);
  EXPECT_TRUE(static_cast<bool>(simulation));
  const auto centre = [&](Tick tick) {
    EXPECT_FALSE(simulation->advance_to(tick).has_value());
    const Snapshot now = simulation->snapshot();
    Vec2 mean = Vec2::Zero();
    for (std::size_t i = 0; i < now.n_rods(); ++i) {
      const Vec2 place(now.position[i].x() + now.image[i][0] * now.box.x(),
                       now.position[i].y() + now.image[i][1] * now.box.y());
      mean += place / static_cast<double>(now.n_rods());
    }
    return mean;
  };
  const Vec2 first = centre(6250);
  return centre(68750) - first;
}

// A straight stroke that rises along x throws rods along x. Half a period later it is the mirror image, and so it is if
// its direction is turned by 180 degrees.
TEST(HorizontalVibration, ConveysAlongItsStrokeAndBackwardsWhenThatIsTurned) {
  const Vec2 along_x = mean_drift(0, 0);
  EXPECT_GT(along_x.x(), 15);
  EXPECT_LT(std::abs(along_x.y()), 3);
  EXPECT_LT(std::abs(mean_drift(180, 0).x() + along_x.x()), 6);
  EXPECT_LT(std::abs(mean_drift(0, 180).x() + along_x.x()), 6);
  const Vec2 along_y = mean_drift(0, 90);
  EXPECT_GT(along_y.y(), 15) << "across the rods, which lie along x";
  EXPECT_LT(std::abs(along_y.x()), 3);
}

}  // namespace
}  // namespace shaken
