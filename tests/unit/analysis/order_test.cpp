#include "analysis/order.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <numeric>

#include "analysis/geometry/periodic.h"
#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

TEST(NematicOrder, AlignedRodsGiveOneAndTheirAngle) {
  for (const double theta : {-1.5, -0.4, 0.0, 0.7, 1.5}) {
    const std::vector<Vec3> rods{axis(theta), axis(theta + kPi, 0.1), axis(theta, -0.3)};
    const NematicOrder order = nematic_order(rods);
    EXPECT_NEAR(order.order, 1.0, 1e-15);
    EXPECT_NEAR(order.director, theta, 1e-15);
  }
}

TEST(NematicOrder, DirectorAlongYIsReportedAsMinusHalfPi) {
  EXPECT_EQ(nematic_order(std::vector<Vec3>{{0, 1, 0}}).director, -kPi / 2);
}

TEST(NematicOrder, OfTwoRodsIsTheCosineOfTheAngleBetweenThem) {
  EXPECT_NEAR(nematic_order(std::vector<Vec3>{axis(0.3), axis(0.3 + kPi / 2)}).order, 0.0, 1e-15);
  const NematicOrder order = nematic_order(std::vector<Vec3>{axis(0.5), axis(0.9)});
  EXPECT_NEAR(order.order, std::cos(0.4), 1e-15);
  EXPECT_NEAR(order.director, 0.7, 1e-15);
}

TEST(NematicOrder, UprightRodsAreLeftOut) {
  const std::vector<Vec3> rods{axis(0.5), {0, 0, 1}, {0, 0, -1}};
  EXPECT_NEAR(nematic_order(rods).order, 1.0, 1e-15);
  EXPECT_EQ(nematic_order(std::vector<Vec3>{{0, 0, 1}}).order, 0.0);
}

TEST(NematicOrder, RotatingTheRodsTurnsTheDirectorAndKeepsTheOrder) {
  EXPECT_TRUE(rc::check("rotation", [](std::uint64_t seed) {
    Draw draw(seed);
    const double angle = draw.uniform(-10, 10);
    std::vector<Vec3> rods, turned;
    const auto n = *rc::gen::inRange(1, 50);
    for (int i = 0; i < n; ++i) {
      const double theta = draw.uniform(-1, 1), n_z = draw.uniform(-0.5, 0.5);
      rods.push_back(axis(theta, n_z));
      turned.push_back(axis(theta + angle, n_z));
    }
    const NematicOrder before = nematic_order(rods);
    const NematicOrder after = nematic_order(turned);
    RC_ASSERT(std::abs(before.order - after.order) < 1e-13);
    RC_ASSERT(std::abs(fold_half_turn(after.director - before.director - angle)) < 1e-13 / before.order);
    RC_ASSERT(after.director >= -kPi / 2 && after.director < kPi / 2);
  }));
}

TEST(Fold, BringsAnyAngleIntoTheHalfTurn) {
  EXPECT_TRUE(rc::check("fold", [](std::int32_t number) {
    const double theta = number * 1e-4;
    const double folded = fold_half_turn(theta);
    RC_ASSERT(folded >= -kPi / 2 && folded < kPi / 2);
    RC_ASSERT(std::abs(std::sin(theta - folded)) < 1e-9);
  }));
  EXPECT_EQ(fold_half_turn(kPi / 2), -kPi / 2);
  EXPECT_EQ(fold_half_turn(-kPi / 2), -kPi / 2);
  EXPECT_LT(fold_half_turn(std::nextafter(kPi / 2, 0)), kPi / 2);
}

TEST(OrderSeries, RunningMeanIsThatOfTheLaterHalf) {
  Draw draw(3);
  OrderSeries series;
  EXPECT_EQ(series.running_mean(), 0.0);
  for (int n = 1; n <= 40; ++n) {
    series.accumulate(n, random_axes(draw, 10));
    const std::vector<double>& s = series.orders();
    const auto later = s.begin() + n / 2;
    EXPECT_NEAR(series.running_mean(), std::accumulate(later, s.end(), 0.0) / static_cast<double>(s.end() - later),
                1e-14);
  }
}

TEST(OrderSeries, ReduceStartsWhereTold) {
  OrderSeries series;
  for (int i = 0; i < 10; ++i) {
    series.accumulate(i * 0.1, i < 5 ? std::vector<Vec3>{axis(0), axis(kPi / 2)} : std::vector<Vec3>{axis(0)});
  }
  EXPECT_NEAR(series.reduce(0.5).mean, 1.0, 1e-15);
  EXPECT_NEAR(series.reduce(0.0).mean, 0.5, 1e-15);
  EXPECT_THROW(series.accumulate(0.2, std::vector<Vec3>{axis(0)}), std::logic_error);
  EXPECT_EQ(OrderSeries().reduce().n_effective, 0.0);
}

// Twice as many samples as there are points, and a half again: then each point is the mean over four successive ones.
TEST(OrderSeries, OfALongRunIsOfAverages) {
  constexpr std::size_t kPoints = kMostSeriesPoints;
  constexpr std::size_t kSamples = 5 * kPoints / 2 + 3;
  const auto order = [](std::size_t i) { return 0.5 + 0.4 * std::sin(0.1 * static_cast<double>(i)); };
  const auto director = [](std::size_t i) {
    return 1.5 + 0.1 * std::cos(0.01 * static_cast<double>(i));
  };  // passes pi/2
  OrderSeries series, stopped;
  std::size_t most = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const NematicOrder sample{order(i), fold_half_turn(director(i))};
    series.accumulate(0.01 * static_cast<double>(i), sample);
    stopped.accumulate(0.01 * static_cast<double>(i), sample);
    if (i % 50001 == 0 || i == kPoints || i == kPoints + 1 || i == 2 * kPoints + 1)
      stop_and_go_on(stopped, OrderSeries());
    most = std::max(most, series.times().size());
  }
  EXPECT_EQ(most, kPoints - 1);
  EXPECT_EQ(state(series), state(stopped));
  ASSERT_EQ(series.times().size(), kSamples / 4);
  for (const std::size_t k :
       {std::size_t{0}, std::size_t{1}, std::size_t{777}, kPoints / 2 - 1, kPoints / 2, kSamples / 4 - 1}) {
    double mean = 0, time = 0;
    Vec2 axis_sum = Vec2::Zero();
    for (std::size_t i = 4 * k; i < 4 * k + 4; ++i) {
      mean += order(i) / 4;
      time += 0.01 * static_cast<double>(i) / 4;
      axis_sum += order(i) * Vec2(std::cos(2 * director(i)), std::sin(2 * director(i)));
    }
    EXPECT_NEAR(series.orders()[k], mean, 1e-12) << k;
    EXPECT_NEAR(series.times()[k], time, 1e-9) << k;
    const double expected = 0.5 * std::atan2(axis_sum.y(), axis_sum.x());
    EXPECT_NEAR(fold_half_turn(series.directors()[k] - expected), 0.0, 1e-9) << k;
  }
  const std::vector<double>& s = series.orders();
  const auto later = s.begin() + static_cast<std::ptrdiff_t>(s.size() / 2);
  EXPECT_NEAR(series.running_mean(), std::accumulate(later, s.end(), 0.0) / static_cast<double>(s.end() - later), 1e-9);
  EXPECT_THROW(series.accumulate(0.01 * static_cast<double>(kSamples - 1), NematicOrder{}), std::logic_error);
}

TEST(OrderStatistics, OfAHandfulOfValues) {
  OrderStatistics statistics(4);
  for (const double order : {0.1, 0.3, 0.3, 1.0}) statistics.accumulate(order);
  statistics.accumulate(std::nan(""));
  const OrderDistribution result = statistics.reduce();
  EXPECT_EQ(result.order, (std::vector<double>{0.125, 0.375, 0.625, 0.875}));
  EXPECT_EQ(result.density, (std::vector<double>{1, 2, 0, 1}));
  EXPECT_NEAR(result.variance, (0.1 * 0.1 + 2 * 0.09 + 1) / 4 - 0.425 * 0.425, 1e-15);
  const double square = (0.01 + 0.18 + 1) / 4, fourth = (0.0001 + 2 * 0.0081 + 1) / 4;
  EXPECT_NEAR(result.binder, 2 - fourth / (square * square), 1e-14);
}

TEST(OrderStatistics, OfNothing) {
  EXPECT_THROW(OrderStatistics(0), std::logic_error);
  EXPECT_TRUE(std::isnan(OrderStatistics(10).reduce().binder));
  EXPECT_TRUE(std::isnan(OrderStatistics(10).reduce().variance));
}

}  // namespace
}  // namespace shaken::analysis
