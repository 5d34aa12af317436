// The pressure of hard discs: spheres between plates that leave them no room to pass each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "analysis/stress.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

System elastic_discs(int count, double area_fraction) {
  constexpr double kDiameter = 0.8;
  System system;
  system.rod = {.length = kDiameter, .mid_diameter = kDiameter, .end_diameter = kDiameter, .n_beads = 1};
  system.n_rods = count;
  system.box_side = std::sqrt(count * kPi / 4 * kDiameter * kDiameter / area_fraction);
  system.gap = 1.0025 * kDiameter;
  system.amplitude = 0;
  system.gravity = 0;
  for (Contacts* contact : {&system.rod_rod, &system.rod_base, &system.rod_lid}) *contact = {0.0, 1.0};
  return system;
}

/// P A / (N T) of the time from `begin` to `end` [s].
double compressibility(Simulation& simulation, double begin, double end) {
  const World& world = simulation.world();
  const std::vector<double> masses(world.rods.size(), world.species.front().mass);
  analysis::StressSeries series(masses.size());
  constexpr int kSamples = 400;
  for (int k = 0; k <= kSamples; ++k) {
    const double time = begin + (end - begin) * k / kSamples;
    EXPECT_FALSE(simulation.advance_to(static_cast<Tick>(std::lround(time / world.system.dt))).has_value());
    analysis::StressTotals totals;
    totals.momentum_flux = analysis::momentum_flux(masses, simulation.snapshot().velocity);
    for (std::size_t c = 0; c < 4; ++c) totals.virial[c] = world.counters.ledger.virial[c].value();
    series.accumulate(time, totals, world.system.box().area(), 0);
  }
  const analysis::Pressure found = series.sums().all().reduce(masses.size());
  return 1 + found.collisional / found.kinetic;
}

class HardDiscs : public testing::TestWithParam<double> {};

// Z = (1 + f^2 / 8) / (1 - f)^2: Henderson, Mol. Phys. 30, 971 (1975).
TEST_P(HardDiscs, HaveTheirEquationOfState) {
  auto simulation = test::good(Simulation::start(elastic_discs(300, GetParam())));
  const double found = compressibility(*simulation, 1, 9);
  const double expected = (1 + GetParam() * GetParam() / 8) / ((1 - GetParam()) * (1 - GetParam()));
  std::printf("area fraction %.2f: Z = %.4f, %.4f expected\n", GetParam(), found, expected);
  EXPECT_NEAR(found / expected, 1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Packings, HardDiscs, testing::Values(0.1, 0.3, 0.5));

// Of impacts without friction between spheres the impulse lies along the way from centre to centre: xy = yx.
TEST(Virial, OfSpheresWithoutFrictionIsSymmetric) {
  auto simulation = test::good(Simulation::start(elastic_discs(60, 0.4)));
  ASSERT_FALSE(simulation->advance_to(100000).has_value());
  const auto& virial = simulation->world().counters.ledger.virial;
  EXPECT_GT(virial[0].value(), 0);
  EXPECT_GT(virial[3].value(), 0);
  EXPECT_NEAR(virial[1].value(), virial[2].value(), 1e-9 * virial[0].value());
}

// Two discs of 0.8 mm that meet head on, found 0.1 mm deep in each other: the way is that from centre to centre.
TEST(Virial, OfDiscsThatOverlapIsOfTheirCentres) {
  constexpr double kSpeed = 50, kApart = 0.7;
  World world = empty_world(elastic_discs(2, 0.1));
  const double y = world.system.box_side / 2, z = world.system.gap / 2;
  for (const double side : {-1.0, 1.0}) {
    Flight flight;
    begin_flight(flight, 0, {{y + side * kApart / 2, y, z}, Vec3::UnitX()}, {{-side * kSpeed, 0, 0}, Vec3::Zero()},
                 world.system.box(), 1);
    world.rods.push_back(flight);
  }
  const double mass = world.species.front().mass, dt = world.system.dt;
  auto simulation = Simulation::start_from(std::move(world));
  ASSERT_FALSE(simulation.advance_to(1).has_value());
  const double distance = kApart - 2 * kSpeed * dt, impulse = 2 * mass * kSpeed;
  EXPECT_NEAR(simulation.world().counters.ledger.virial[0].value(), distance * impulse, 1e-9 * impulse);
  EXPECT_EQ(simulation.world().counters.ledger.virial[3].value(), 0);
}

}  // namespace
}  // namespace shaken
