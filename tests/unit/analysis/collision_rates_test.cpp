#include "analysis/collision_rates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

double of(const CollisionRates& rates, CollisionCount count) { return rates[static_cast<std::size_t>(count)]; }

// Ten rods, after a start at which some things have happened already.
TEST(CollisionSeries, RatesAreDifferencesOfTotals) {
  CollisionSeries series;
  series.accumulate(1, {{100, 200, 300, 400, 5000, 600, 700}, 10});
  EXPECT_TRUE(series.times().empty());
  EXPECT_TRUE(std::isnan(of(series.sums().all().reduce(), CollisionCount::kRodRod)));
  series.accumulate(1.5, {{130, 210, 320, 400, 5100, 650, 730}, 10});
  series.accumulate(2, {{140, 240, 330, 405, 5200, 650, 780}, 10});
  EXPECT_EQ(series.times(), (std::vector<double>{1.5, 2}));
  // in half a second 30 and 10 impacts of two rods each
  EXPECT_EQ(series.of(CollisionCount::kRodRod), (std::vector<double>{12, 4}));
  EXPECT_EQ(series.of(CollisionCount::kBase), (std::vector<double>{2, 6}));
  EXPECT_EQ(series.of(CollisionCount::kWalls), (std::vector<double>{0, 1}));
  EXPECT_EQ(series.of(CollisionCount::kGiven), (std::vector<double>{20, 20}));
  EXPECT_EQ(series.of(CollisionCount::kLostRodRod), (std::vector<double>{10, 0}));
  const CollisionRates all = series.sums().all().reduce();
  EXPECT_NEAR(of(all, CollisionCount::kRodRod), 8, 1e-12);
  EXPECT_NEAR(of(all, CollisionCount::kLid), 3, 1e-12);
  EXPECT_NEAR(of(all, CollisionCount::kLostSurfaces), 8, 1e-12);
  EXPECT_NEAR(of(series.sums().after(1.5).reduce(), CollisionCount::kRodRod), 4, 1e-12);
  EXPECT_THROW(series.accumulate(2, {{}, 10}), std::logic_error);
}

// Random impacts at given rates: the mean rate is found within its own Poisson error, and the integral of the series is
// all that happened.
TEST(CollisionSeries, OfRandomImpactsHasTheirRate) {
  constexpr double kRods = 50, kRate = 400, kStep = 0.01;  // pairs of rods per second
  Draw draw(361);
  CollisionSeries series;
  CollisionTotals totals{{}, kRods};
  const auto rod_rod = static_cast<std::size_t>(CollisionCount::kRodRod);
  double next = -std::log(1 - draw.uniform(0, 1)) / kRate;
  constexpr int kSteps = 5000;
  for (int i = 0; i <= kSteps; ++i) {
    for (; next <= i * kStep; next -= std::log(1 - draw.uniform(0, 1)) / kRate) totals.since_start[rod_rod] += 1;
    series.accumulate(i * kStep, totals);
  }
  const double expected = kRate * kStep * kSteps;
  EXPECT_NEAR(of(series.sums().all().reduce(), CollisionCount::kRodRod), 2 * kRate / kRods,
              4.5 * 2 * kRate / kRods / std::sqrt(expected));
  double integral = 0;
  for (const double rate : series.of(CollisionCount::kRodRod)) integral += rate * kStep * kRods / 2;
  EXPECT_NEAR(integral, totals.since_start[rod_rod], 1e-9 * expected);
}

TEST(CollisionSums, Merge) {
  CollisionSums first, second;
  first.accumulate(1, 2, {2, 4, 6, 8, 10, 12, 14});
  second.accumulate(3, 2, {6, 4, 2, 0, 0, 0, 2});
  first.merge(second);
  EXPECT_EQ(first.reduce(), (CollisionRates{2, 1, 1, 1, 1.25, 1.5, 2}));
}

}  // namespace
}  // namespace shaken::analysis
