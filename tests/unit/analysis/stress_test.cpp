// SPDX-License-Identifier: MIT
#include "analysis/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

TEST(MomentumFlux, IsOfMotionAboutTheCentreOfMass) {
  // 1 mg at (6, 0) and 3 mg at (2, 4) mm/s: the centre of mass goes at (3, 3)
  const std::vector<double> masses{1, 3};
  const std::vector<Vec3> velocities{{6, 0, 7}, {2, 4, -9}};
  EXPECT_EQ(momentum_flux(masses, velocities), (PlaneTensor{12, -12, -12, 12}));
  EXPECT_THROW(momentum_flux(std::vector<double>{1}, velocities), std::logic_error);
}

// By Galilei: a common velocity changes nothing. Of many rods that move at random, it is N m <v^2>.
TEST(MomentumFlux, OfRandomVelocitiesIsTheirVariance) {
  Draw draw(912);
  constexpr int kRods = 40000;
  std::vector<double> masses(kRods, 2.0);
  std::vector<Vec3> still, moving;
  for (int i = 0; i < kRods; ++i) {
    still.emplace_back(3 * draw.normal(), 5 * draw.normal(), draw.normal());
    moving.push_back(still.back() + Vec3(100, -70, 30));
  }
  const PlaneTensor flux = momentum_flux(masses, still), of_moving = momentum_flux(masses, moving);
  EXPECT_NEAR(flux[0] / (kRods * 2 * 9), 1, 4 * std::sqrt(2.0 / kRods));
  EXPECT_NEAR(flux[3] / (kRods * 2 * 25), 1, 4 * std::sqrt(2.0 / kRods));
  EXPECT_NEAR(flux[1] / (kRods * 2 * 15), 0, 4 * std::sqrt(1.0 / kRods));
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(of_moving[k], flux[k], 1e-9 * flux[3]) << k;
}

TEST(StressSeries, IsOfTheTimeSinceTheSampleBefore) {
  StressSeries series;
  series.accumulate(1, {{10, 2, 2, 20}, {100, 200, 300, 400}}, 5, 0);
  EXPECT_TRUE(series.times().empty());
  EXPECT_TRUE(std::isnan(series.sums().all().reduce().along));
  series.accumulate(1.5, {{30, 2, 2, 40}, {110, 205, 300, 430}}, 5, 0);
  series.accumulate(2.5, {{50, 0, 0, 60}, {115, 205, 301, 430}}, 5, std::numbers::pi / 2);
  EXPECT_EQ(series.times(), (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(series.kinetic(0), (std::vector<double>{4, 8}));
  EXPECT_EQ(series.kinetic(3), (std::vector<double>{6, 10}));
  EXPECT_EQ(series.collisional(0), (std::vector<double>{4, 1}));
  EXPECT_EQ(series.collisional(1), (std::vector<double>{2, 0}));
  EXPECT_EQ(series.collisional(3), (std::vector<double>{12, 0}));
  // the director turns from x to y: along it first xx, then yy, by their times
  const Pressure all = series.sums().all().reduce();
  EXPECT_NEAR(all.along, ((4 + 4) * 0.5 + (10 + 0) * 1) / 1.5, 1e-12);
  EXPECT_NEAR(all.across, ((6 + 12) * 0.5 + (8 + 1) * 1) / 1.5, 1e-12);
  EXPECT_NEAR(all.kinetic, (5 * 0.5 + 9 * 1) / 1.5, 1e-12);
  EXPECT_NEAR(all.collisional, (8 * 0.5 + 0.5 * 1) / 1.5, 1e-12);
  EXPECT_NEAR(series.sums().after(1.5).reduce().along, 10, 1e-12);
  EXPECT_THROW(series.accumulate(2.5, {}, 5, 0), std::logic_error);
}

// A tensor that is aligned with the director at any angle has its eigenvalues along and across it.
TEST(PressureSums, FollowTheDirector) {
  Draw draw(77);
  for (int i = 0; i < 20; ++i) {
    const double angle = draw.uniform(-4, 4), first = draw.uniform(0, 9), second = draw.uniform(0, 9);
    const double c = std::cos(angle), s = std::sin(angle);
    const PlaneTensor tensor{c * c * first + s * s * second, c * s * (first - second), c * s * (first - second),
                             s * s * first + c * c * second};
    PressureSums sums;
    sums.accumulate(2, tensor, {}, angle);
    EXPECT_NEAR(sums.reduce().along, first, 1e-12);
    EXPECT_NEAR(sums.reduce().across, second, 1e-12);
  }
}

TEST(StressSeries, SavesAndRestores) {
  StressSeries straight, stopped;
  for (int i = 0; i < 20; ++i) {
    const double n = i * i;
    const StressTotals totals{{n, 1 / (n + 1), 2, 3 * n}, {n / 3, n / 7, n / 11, n / 13}};
    straight.accumulate(i, totals, 3, 0.1 * i);
    stopped.accumulate(i, totals, 3, 0.1 * i);
    stop_and_go_on(stopped, StressSeries());
  }
  EXPECT_EQ(state(straight), state(stopped));
  expect_every_truncation_found(stopped);
}

}  // namespace
}  // namespace shaken::analysis
