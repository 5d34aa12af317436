#include "analysis/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

/// So many rods that the mean velocity of all takes nothing of theirs.
constexpr std::size_t kMany = std::size_t{1} << 60;

TEST(MomentumFlux, IsOfMotionAboutTheCentreOfMass) {
  // 1 mg at (6, 0) and 3 mg at (2, 4) mm/s: the centre of mass goes at (3, 3)
  const std::vector<double> masses{1, 3};
  const std::vector<Vec3> velocities{{6, 0, 7}, {2, 4, -9}};
  EXPECT_EQ(momentum_flux(masses, velocities), (PlaneTensor{12, -12, -12, 12}));
  EXPECT_THROW(momentum_flux(std::vector<double>{1}, velocities), std::logic_error);
}

// Of independent rods of unequal masses and equal temperature the kinetic part is N T / A, however few there are.
TEST(StressSeries, KineticPartOfFewRodsIsThatOfAGas) {
  constexpr int kDraws = 40000;
  const std::vector<double> masses{1, 4, 9};
  Draw draw(913);
  StressSeries series(masses.size());
  for (int i = 0; i < kDraws; ++i) {
    std::vector<Vec3> velocities;
    for (const double mass : masses) velocities.emplace_back(Vec3(draw.normal(), draw.normal(), 0) / std::sqrt(mass));
    series.accumulate(i, {momentum_flux(masses, velocities), {}}, 1, 0);
  }
  const Pressure found = series.sums().all().reduce(masses.size());
  EXPECT_NEAR(found.kinetic, 3, 4.5 * 3 / std::sqrt(2.0 * kDraws));  // half of chi squared of four degrees, times 3 / 2
  const std::vector<double> series_xx = series.kinetic(0);
  EXPECT_NEAR(std::accumulate(series_xx.begin(), series_xx.end(), 0.0) / static_cast<double>(series_xx.size()), 3,
              4.5 * 3 / std::sqrt(1.0 * kDraws));
  EXPECT_TRUE(std::isnan(series.sums().all().reduce(1).along));
  EXPECT_EQ(series.sums().all().reduce(1).collisional, 0);
}

TEST(StressSeries, IsOfTheTimeSinceTheSampleBefore) {
  StressSeries series(kMany);
  series.accumulate(1, {{10, 2, 2, 20}, {100, 200, 300, 400}}, 5, 0);
  EXPECT_TRUE(series.times().empty());
  EXPECT_TRUE(std::isnan(series.sums().all().reduce(kMany).along));
  series.accumulate(1.5, {{30, 2, 2, 40}, {110, 205, 300, 430}}, 5, 0);
  series.accumulate(2.5, {{50, 0, 0, 60}, {115, 205, 301, 430}}, 5, std::numbers::pi / 2);
  EXPECT_EQ(series.times(), (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(series.kinetic(0), (std::vector<double>{4, 8}));
  EXPECT_EQ(series.kinetic(3), (std::vector<double>{6, 10}));
  EXPECT_EQ(series.collisional(0), (std::vector<double>{4, 1}));
  EXPECT_EQ(series.collisional(1), (std::vector<double>{2, 0}));
  EXPECT_EQ(series.collisional(3), (std::vector<double>{12, 0}));
  // the director turns from x to y: along it first xx, then yy, by their times
  const Pressure all = series.sums().all().reduce(kMany);
  EXPECT_NEAR(all.along, ((4 + 4) * 0.5 + (10 + 0) * 1) / 1.5, 1e-12);
  EXPECT_NEAR(all.across, ((6 + 12) * 0.5 + (8 + 1) * 1) / 1.5, 1e-12);
  EXPECT_NEAR(all.kinetic, (5 * 0.5 + 9 * 1) / 1.5, 1e-12);
  EXPECT_NEAR(all.collisional, (8 * 0.5 + 0.5 * 1) / 1.5, 1e-12);
  EXPECT_NEAR(series.sums().after(1.5).reduce(kMany).along, 10, 1e-12);
  EXPECT_THROW(series.accumulate(2.5, {}, 5, 0), std::logic_error);
}

// With friction the tensor of impacts is not symmetric: along (1, 1) / sqrt(2) it is half the sum of all components.
TEST(PressureSums, OfATensorThatIsNotSymmetric) {
  PressureSums sums;
  sums.accumulate(1, {}, {1, 20, 300, 4000}, std::numbers::pi / 4);
  EXPECT_NEAR(sums.reduce(kMany).along, (1 + 20 + 300 + 4000) / 2.0, 1e-9);
  EXPECT_NEAR(sums.reduce(kMany).across, (1 - 20 - 300 + 4000) / 2.0, 1e-9);
  EXPECT_NEAR(sums.reduce(kMany).collisional, (1 + 4000) / 2.0, 1e-9);
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
    EXPECT_NEAR(sums.reduce(kMany).along, first, 1e-12);
    EXPECT_NEAR(sums.reduce(kMany).across, second, 1e-12);
  }
}

}  // namespace
}  // namespace shaken::analysis
