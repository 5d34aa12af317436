// Elastic rods without friction between plates at rest come to thermal equilibrium: every degree of freedom that
// impacts can excite gets the same temperature.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "analysis/temperatures.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

using analysis::Freedom;

TEST(Equipartition, OfElasticRodsBetweenPlatesAtRest) {
  System system = test::short_rods(200, 22);
  system.amplitude = 0;
  system.gravity = 0;
  for (ContactParameters* contact : {&system.rod_rod, &system.rod_base, &system.rod_lid}) *contact = {0.0, 1.0};
  auto simulation = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(simulation));
  const Species& rods = simulation->world().species.front();
  const analysis::RodInertia inertia[]{{rods.mass, rods.inertia_perp, rods.inertia_par}};
  const auto temperatures = [&] {
    const Snapshot now = simulation->snapshot();
    return analysis::granular_temperatures(now.director, now.velocity, now.angular_velocity, inertia);
  };
  const auto of = [](const analysis::Temperatures& all, Freedom freedom) {
    return all[static_cast<std::size_t>(freedom)];
  };
  const analysis::Temperatures start = temperatures();
  const auto settle = static_cast<Tick>(std::lround(0.3 / system.dt)), step = settle / 30;
  analysis::TemperatureStatistics mean;
  for (Tick k = step; k <= 15 * settle; k += step) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    if (k > settle) mean.accumulate(temperatures(), simulation->snapshot().velocity);
  }
  const analysis::Temperatures found = mean.reduce();
  for (std::size_t k = 0; k < analysis::kFreedoms; ++k) std::printf("%zu: %.2f -> %.2f pJ\n", k, start[k], found[k]);
  // Nothing spins rods without friction; the others share.
  const double temperature = (2 * of(found, Freedom::kHorizontal) + of(found, Freedom::kVertical) +
                              of(found, Freedom::kTurning) + of(found, Freedom::kTipping)) /
                             5;
  for (const Freedom freedom : {Freedom::kHorizontal, Freedom::kVertical, Freedom::kAlong, Freedom::kAcross,
                                Freedom::kTurning, Freedom::kTipping}) {
    EXPECT_NEAR(of(found, freedom), temperature, 0.03 * temperature) << static_cast<std::size_t>(freedom);
  }
  EXPECT_NEAR(of(found, Freedom::kSpinning), of(start, Freedom::kSpinning), 1e-9 * temperature);
}

}  // namespace
}  // namespace shaken
