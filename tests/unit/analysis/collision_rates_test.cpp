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

TEST(CollisionSums, Merge) {
  CollisionSums first, second;
  first.accumulate(1, 2, {2, 4, 6, 8, 10, 12, 14});
  second.accumulate(3, 2, {6, 4, 2, 0, 0, 0, 2});
  first.merge(second);
  EXPECT_EQ(first.reduce(), (CollisionRates{2, 1, 1, 1, 1.25, 1.5, 2}));
}

}  // namespace
}  // namespace shaken::analysis
