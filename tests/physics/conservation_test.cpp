// Conservation laws of whole runs, tick by tick.
#include <gtest/gtest.h>

#include "sim/balance.h"
#include "sim/simulation.h"
#include "tests/support/good.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

double potential_energy(const World& world) {
  double sum = 0;
  for (const Vec3& r : snapshot(world).position) sum += world.species[0].mass * world.system.gravity * r.z();
  return sum;
}

Vec3 momentum(const World& world) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : snapshot(world).velocity) sum += world.species[0].mass * v;
  return sum;
}

TEST(Conservation, MomentumInThePlaneWithoutPlateFriction) {
  System system = test::short_rods(74);
  system.rod_base.friction = 0;
  system.rod_lid.friction = 0;
  auto simulation = test::good(Simulation::start(system));
  const Vec3 start = momentum(simulation->world());
  const double scale = simulation->world().species[0].mass * 20 * system.n_rods;
  for (Tick k = 500; k <= 10000; k += 500) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    const Vec3 change = momentum(simulation->world()) - start;
    EXPECT_LT(std::hypot(change.x(), change.y()), 1e-12 * scale);
  }
  EXPECT_GT(simulation->world().counters.impulses_rod_rod, 500);
  EXPECT_GT(simulation->world().counters.impulses_rod_base, 500);
}

TEST(Conservation, PlateFrictionDoesTakeMomentum) {
  // the twin that shows that the test above can fail
  System system = test::short_rods(74);
  auto simulation = test::good(Simulation::start(system));
  const Vec3 start = momentum(simulation->world());
  ASSERT_FALSE(simulation->advance_to(10000).has_value());
  const Vec3 change = momentum(simulation->world()) - start;
  EXPECT_GT(std::hypot(change.x(), change.y()), 1e-6 * simulation->world().species[0].mass * 20 * system.n_rods);
}

TEST(Conservation, EnergyNeverGrowsBetweenPlatesAtRest) {
  System system = test::short_rods(74);
  system.amplitude = 0;
  system.gravity = 0;
  auto simulation = test::good(Simulation::start(system));
  double energy = kinetic_energy(simulation->world()).total();
  const double start = energy;
  for (Tick k = 1; k <= 8000; ++k) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    const double now = kinetic_energy(simulation->world()).total();
    ASSERT_LE(now, energy + 1e-12 * start) << "energy made at tick " << k;
    energy = now;
  }
  EXPECT_LT(energy, 0.9 * start);
}

TEST(Conservation, UnderGravityRodsAtRestAreHeldUpByNoMoreThanAFallOfOneTick) {
  System system = test::short_rods(74);
  system.amplitude = 0;
  auto simulation = test::good(Simulation::start(system));
  const double tick_fall = system.gravity * system.dt;
  const double held = system.n_rods * simulation->world().species.front().mass * tick_fall * tick_fall;
  double energy = kinetic_energy(simulation->world()).total() + potential_energy(simulation->world());
  const double start = energy;
  for (Tick k = 1; k <= 8000; ++k) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    const double now = kinetic_energy(simulation->world()).total() + potential_energy(simulation->world());
    ASSERT_LE(now, energy + 1e-12 * start + held) << "energy made at tick " << k;
    energy = now;
  }
  EXPECT_LT(energy, 0.9 * start);
}

TEST(Conservation, ElasticFrictionlessRodsBetweenPlatesAtRestKeepTheirEnergy) {
  System system = test::short_rods(74);
  system.amplitude = 0;
  system.rod_rod = system.rod_base = system.rod_lid = {0.0, 1.0};
  auto simulation = test::good(Simulation::start(system));
  const double start = kinetic_energy(simulation->world()).total() + potential_energy(simulation->world());
  ASSERT_FALSE(simulation->advance_to(10000).has_value());
  const double end = kinetic_energy(simulation->world()).total() + potential_energy(simulation->world());
  EXPECT_NEAR(end, start, 1e-11 * start);
  EXPECT_GT(simulation->world().counters.impulses_rod_rod, 100);
}

TEST(Conservation, FrictionlessContactsNeverTurnARodAboutItsAxis) {
  System system = test::short_rods(74);
  system.rod_rod.friction = system.rod_base.friction = system.rod_lid.friction = 0;
  auto simulation = test::good(Simulation::start(system));
  ASSERT_FALSE(simulation->advance_to(10000).has_value());
  for (const Flight& flight : simulation->world().rods) EXPECT_NEAR(flight.spin, 0, 1e-11);
}

TEST(Overlap, ShrinksWithTheTick) {
  double last = 1e9;
  for (const double dt : {16e-6, 4e-6, 1e-6}) {
    System system = test::short_rods(74);
    system.dt = dt;
    auto simulation = test::good(Simulation::start(system));
    ASSERT_FALSE(simulation->advance_to(static_cast<Tick>(0.03 / dt)).has_value());
    const double overlap = simulation->world().counters.max_overlap();
    EXPECT_GT(overlap, 0);
    EXPECT_LT(overlap, 0.5 * last);
    last = overlap;
  }
}

TEST(Trouble, DeepOverlapStopsWithTickAndRods) {
  // a tick in which a rod crosses half the gap: nobody should believe what follows, and nobody is asked to
  System system = test::short_rods(74);
  system.dt = 4e-3;
  auto simulation = test::good(Simulation::start(system));
  const auto trouble = simulation->advance_to(1000);
  ASSERT_TRUE(trouble.has_value());
  EXPECT_EQ(trouble->tick, simulation->tick());
  EXPECT_FALSE(trouble->rods.empty());
  EXPECT_FALSE(trouble->what.empty());
}

// What the tick that fails has entered into the ledger is of motions that are never stored.
TEST(Trouble, TheBalanceOfWhatWentBeforeCloses) {
  for (const StepperKind stepper : {StepperKind::kReference, StepperKind::kScheduled}) {
    System system = test::short_rods(74);
    system.dt = 1e-3;
    system.stepper = stepper;
    auto simulation = test::good(Simulation::start(system));
    ASSERT_TRUE(simulation->advance_to(100000).has_value());
    const Balance found = balance(simulation->world());
    EXPECT_GT(found.energy_given_by_surfaces, 0) << "some ticks went well";
    EXPECT_LT(found.energy_error(), 1e-9);
  }
}

}  // namespace
}  // namespace shaken
