#include "analysis/order_statistics.h"

#include <gtest/gtest.h>

#include "analysis/order.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

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

// <S^4> of N random unit vectors in the plane is (2 N^2 - N) / N^4, so that U2 = 1 / N; S rods in perfect order give 1.
// The error of U2 over R samples: S^2 N is exponential with mean 1, and U2 = 2 - m2 / m1^2 has the variance
// (var m2 - 8 cov + 16 var m1) / R = (20 - 8 * 4 + 16) / R.
TEST(OrderStatistics, BinderCumulantOfDisorderAndOrder) {
  constexpr double kRods = 50, kRepeats = 20000;
  Draw draw(141);
  OrderStatistics random(100), ordered(100);
  for (int i = 0; i < kRepeats; ++i) {
    random.accumulate(nematic_order(random_axes(draw, static_cast<std::size_t>(kRods))).order);
    ordered.accumulate(0.9);
  }
  EXPECT_LT(std::abs(random.reduce().binder - 1 / kRods) / std::sqrt(4 / kRepeats), 4.0);
  EXPECT_NEAR(ordered.reduce().binder, 1.0, 1e-9);
  EXPECT_NEAR(ordered.reduce().variance, 0.0, 1e-15);
  // susceptibility of disorder: N var S = 1 - pi / 4
  EXPECT_NEAR(kRods * random.reduce().variance, 1 - kPi / 4, 4 * 0.25 * std::sqrt(2 / kRepeats) * 2);
  // Rayleigh: P[S] = 2 N S exp(-N S^2), less than a thousandth off for 50 rods where it is high
  const OrderDistribution pdf = random.reduce();
  for (std::size_t i = 5; i < 25; ++i) {
    const double s = pdf.order[i], expected = 2 * kRods * s * std::exp(-kRods * s * s);
    const double error = std::sqrt(expected * 100 / kRepeats);
    EXPECT_NEAR(pdf.density[i], expected, 4.5 * error + 0.03 * expected) << s;
  }
}

TEST(OrderStatistics, MergeAndReset) {
  Draw draw(142);
  OrderStatistics first(10), second(10), both(10);
  for (int i = 0; i < 60; ++i) {
    const double order = draw.uniform(0.7, 0.7001);
    (i < 20 ? first : second).accumulate(order);
    both.accumulate(order);
  }
  first.merge(OrderStatistics(10));
  first.merge(second);
  EXPECT_EQ(first.reduce().density, both.reduce().density);
  EXPECT_NEAR(first.reduce().variance / both.reduce().variance, 1.0, 1e-9);
  EXPECT_NEAR(first.reduce().binder, both.reduce().binder, 1e-12);
  EXPECT_THROW(OrderStatistics(11).merge(first), std::logic_error);
  EXPECT_THROW(OrderStatistics(0), std::logic_error);
  EXPECT_TRUE(std::isnan(OrderStatistics(10).reduce().binder));
  EXPECT_TRUE(std::isnan(OrderStatistics(10).reduce().variance));
}

}  // namespace
}  // namespace shaken::analysis
