// A body bounced off a moving plate: v' = V + e (V - v), V the plate's velocity at the instant of the hit.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulation.h"

namespace shaken {
namespace moving_plate_test {

constexpr RodShape kSphere{.length = 0.8, .n_beads = 1};
constexpr RodShape kFlatRod{.length = 2.5, .n_beads = 9};

struct Bounce {
  double before = 0;     ///< velocity of the body at the tick at which it is hit [mm/s]
  double plate = 0;      ///< that of the plates, at the instant of the hit
  double since_hit = 0;  ///< time from that instant to the tick [s]
  double after = 0;      ///< velocity at the tick, after the hit
  std::int64_t n_hits = 0;
};

/// The plate's own motion, worked out here: z = a cos(2 pi f t) + a.
double plate_velocity(const System& system, double time) {
  const double omega = 2 * kPi * system.frequency;
  return -system.amplitude * omega * std::sin(omega * time);
}
double base_height(const System& system, double time) {
  return system.amplitude * std::cos(2 * kPi * system.frequency * time) + system.amplitude;
}

/// Lets a body that lies flat meet base (side 1) or lid (-1) at tick `hit`, at `speed` relative to it, sunk in by
/// `share` of what it approaches in a tick.
Bounce bounce(System system, double side, Tick hit, double speed, double share) {
  const double now = static_cast<double>(hit) * system.dt;
  Bounce bounce;
  const double plate = plate_velocity(system, now);
  bounce.before = plate - side * speed;
  const double overlap = share * speed * system.dt;
  World world = empty_world(system);
  world.tick = hit - 1;
  Flight flight;
  flight.since = hit - 1;
  const double radius = world.species[0].mid_radius;
  const double surface = base_height(system, now) + (side > 0 ? 0.0 : system.gap);
  flight.velocity = {0, 0, bounce.before + system.gravity * system.dt};
  flight.position = {
      5, 5,
      surface + side * (radius - overlap) - bounce.before * system.dt - 0.5 * system.gravity * system.dt * system.dt};
  flight.prepare();
  world.rods = {flight};
  Simulation simulation = Simulation::start_from(world);
  EXPECT_FALSE(simulation.advance_to(hit).has_value());
  const Snapshot after = simulation.snapshot();
  EXPECT_LT(after.velocity[0].head<2>().norm() + after.angular_velocity[0].norm(), 1e-9) << "hit in its middle";
  bounce.after = after.velocity[0].z();
  if (system.impacts == ImpactTime::kAtInstant) bounce.since_hit = overlap / speed;
  bounce.plate = plate_velocity(system, now - bounce.since_hit);
  bounce.before += system.gravity * bounce.since_hit;
  const Counters& counters = simulation.world().counters;
  bounce.n_hits = side > 0 ? counters.impulses_rod_base : counters.impulses_rod_lid;
  return bounce;
}

TEST(MovingPlate, ThrowsABodyBackAsNewtonSays) {
  double fastest_up = 0, fastest_down = 0;
  for (const ImpactTime impacts : {ImpactTime::kTickEnd, ImpactTime::kAtInstant}) {
    for (const RodShape& body : {kSphere, kFlatRod}) {
      for (const double restitution : {0.0, 0.3, 0.7, 1.0}) {
        for (const double friction : {0.0, 0.3}) {
          for (const double side : {1.0, -1.0}) {
            for (int phase = 0; phase < 16; ++phase) {
              System system;
              system.rod = body;
              system.n_rods = 1;
              system.box_side = 12;
              system.impacts = impacts;
              system.rod_base = system.rod_lid = {friction, restitution};
              const double period = 1 / (system.frequency * system.dt);
              const auto hit = static_cast<Tick>(std::round(period * (7 + (phase + 0.3) / 16)));
              const Bounce b = bounce(system, side, hit, 25.0 + phase, 0.3);
              ASSERT_EQ(b.n_hits, 1);
              const double expected = b.plate + restitution * (b.plate - b.before) - system.gravity * b.since_hit;
              EXPECT_NEAR(b.after, expected, 1e-8) << "phase " << phase << ", e " << restitution << ", side " << side;
              fastest_up = std::max(fastest_up, b.plate);
              fastest_down = std::min(fastest_down, b.plate);
            }
          }
        }
      }
    }
  }
  // the plates' velocity mattered: up to 55 mm/s either way
  EXPECT_GT(fastest_up, 50);
  EXPECT_LT(fastest_down, -50);
}

// The work that a moving plate does is what the energy balance says that it gave.
TEST(MovingPlate, GivesTheEnergyThatTheBudgetSays) {
  System system;
  system.rod = kSphere;
  system.n_rods = 1;
  system.box_side = 12;
  system.rod_base = {0.0, 0.5};
  const auto hit = static_cast<Tick>(std::round(0.8 / (system.frequency * system.dt)));  // upwards
  World world = empty_world(system);
  const double mass = world.species[0].mass;
  const Bounce b = bounce(system, 1.0, hit, 30, 0.3);
  const double impulse = mass * (b.after - b.before);
  EXPECT_GT(b.plate, 40);
  EXPECT_NEAR(0.5 * mass * (b.after * b.after - b.before * b.before),
              impulse * b.plate - 0.5 * mass * (1 - 0.25) * 30 * 30, 1e-8 * mass * 900);
}

}  // namespace moving_plate_test
}  // namespace shaken
