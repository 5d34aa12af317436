#include "analysis/polar_order.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

TEST(PolarOrder, OfHeadsThatPointTheSameWayAndOpposite) {
  const PolarOrder same = polar_order(std::vector<Vec3>(7, axis(2.5, 0.4)));
  EXPECT_NEAR(same.order, 1.0, 1e-15);
  EXPECT_NEAR(same.direction, 2.5, 1e-14);
  EXPECT_NEAR(polar_order(std::vector<Vec3>{axis(0.3), axis(0.3 - kPi), axis(1.0), axis(1.0 + kPi)}).order, 0, 1e-15);
  // three of four: (3 - 1) / 4
  const PolarOrder most = polar_order(std::vector<Vec3>{axis(-2), axis(-2), axis(-2, 0.1), axis(-2 + kPi)});
  EXPECT_NEAR(most.order, 0.5, 1e-15);
  EXPECT_NEAR(most.direction, -2, 1e-14);
}

TEST(PolarOrder, LeavesOutUprightRods) {
  EXPECT_NEAR(polar_order(std::vector<Vec3>{axis(1), Vec3(0, 0, 1), Vec3(0, 0, -1)}).order, 1.0, 1e-15);
  const PolarOrder none = polar_order(std::vector<Vec3>{Vec3(0, 0, 1)});
  EXPECT_EQ(none.order, 0.0);
  EXPECT_EQ(none.direction, 0.0);
}

TEST(PolarSeries, AveragesDirectionsAsVectors) {
  PolarSeries series;
  for (int i = 0; i < 65536; ++i) series.accumulate(i, {0.5, i % 2 == 0 ? kPi - 0.1 : -kPi + 0.1});
  ASSERT_EQ(series.times().size(), 32768u);
  EXPECT_NEAR(series.times()[1], 2.5, 1e-12);
  EXPECT_NEAR(series.orders()[1], 0.5, 1e-12);
  EXPECT_NEAR(std::abs(series.directions()[1]), kPi, 1e-9);
}

TEST(PolarStatistics, FindsThePlantedVelocities) {
  PolarStatistics statistics;
  const auto take = [&](std::vector<Vec3> directors, std::vector<Vec3> velocities) {
    statistics.accumulate(directors, velocities, polar_order(directors));
  };
  // tails first at 2 mm/s, sideways at 1 mm/s to the left of one and to the right of the other; what is vertical is not
  // in the plane
  const auto velocity = [](double theta, double along, double across) {
    return Vec3(along * axis(theta) + across * axis(theta + kPi / 2) + Vec3(0, 0, 9));
  };
  take({axis(0.4, 0.2), axis(0.4 + kPi / 2, -0.1)}, {velocity(0.4, -2, 1), velocity(0.4 + kPi / 2, -2, -1)});
  // an upright rod, which has no direction but flies, and one that rests
  take({Vec3(0, 0, 1), axis(1)}, {Vec3(3, 4, 0), Vec3::Zero()});
  // rest
  take({axis(1), axis(1)}, {Vec3::Zero(), Vec3::Zero()});
  const PolarNumbers found = statistics.reduce();
  EXPECT_NEAR(found.forward, -4.0 / 5, 1e-14);
  EXPECT_NEAR(found.along_rms, std::sqrt(8.0 / 5), 1e-14);
  EXPECT_NEAR(found.across_rms, std::sqrt(2.0 / 5), 1e-14);
  // (-2, 1) and, a quarter turn on, (-2, -1): (1, -2) in the first one's frame, a sum of (-1, -1) to 2 sqrt(5)
  EXPECT_NEAR(found.velocity_polarity, (std::sqrt(2.0) / (2 * std::sqrt(5.0)) + 1.0) / 2, 1e-14);
  const double p = std::sqrt(0.5), mean = (p + 2) / 3;
  EXPECT_NEAR(found.order, mean, 1e-14);
  EXPECT_NEAR(found.variance, (p * p + 2) / 3 - mean * mean, 1e-14);
}

TEST(PolarStatistics, OfNothing) {
  EXPECT_TRUE(std::isnan(PolarStatistics().reduce().order));
  EXPECT_TRUE(std::isnan(PolarStatistics().reduce().variance));
  EXPECT_TRUE(std::isnan(PolarStatistics().reduce().velocity_polarity));
  EXPECT_THROW(PolarStatistics().accumulate(std::vector<Vec3>(2), std::vector<Vec3>(1), {}), std::logic_error);
}

}  // namespace
}  // namespace shaken::analysis
