// SPDX-License-Identifier: MIT
#include "analysis/msd.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

using Frames = std::vector<std::vector<Vec3>>;

/// Independent walks with steps of spread `along` and `across` an axis at `theta`.
Frames walks(Draw& draw, std::size_t n_rods, std::size_t n_frames, double theta, double along, double across) {
  Frames frames{std::vector<Vec3>(n_rods, Vec3::Zero())};
  const Vec3 n(std::cos(theta), std::sin(theta), 0), m(-std::sin(theta), std::cos(theta), 0);
  while (frames.size() < n_frames) {
    std::vector<Vec3> next = frames.back();
    for (Vec3& r : next) r += along * draw.normal() * n + across * draw.normal() * m;
    frames.push_back(next);
  }
  return frames;
}

TEST(MeanSquareDisplacement, LagsAreFourAnOctave) {
  MeanSquareDisplacement msd(0.5, 3);
  const std::vector<Vec3> still(2, Vec3::Zero()), directors(2, axis(0));
  EXPECT_TRUE(msd.reduce().lag.empty());
  for (int i = 0; i < 100; ++i) msd.accumulate(still, directors);
  EXPECT_EQ(msd.reduce().lag, (std::vector<double>{0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 10, 12, 14, 16}));
  EXPECT_EQ(msd.reduce().total, std::vector<double>(16, 0.0));
}

TEST(MeanSquareDisplacement, OfFlightIsTheSquareOfTheWay) {
  MeanSquareDisplacement msd(0.1, 6);
  const double theta = 0.6;
  for (int i = 0; i < 300; ++i) {
    // Far from the origin: sums of squares of whole positions would lose eight digits.
    msd.accumulate(std::vector<Vec3>{{1e4 + 3.0 * 0.1 * i, 4.0 * 0.1 * i, 0}}, std::vector<Vec3>{axis(theta)});
  }
  const MsdCurve curve = msd.reduce();
  const double along = 3 * std::cos(theta) + 4 * std::sin(theta), across = 4 * std::cos(theta) - 3 * std::sin(theta);
  ASSERT_EQ(curve.lag.size(), 8u + 5 * 4);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const double t2 = curve.lag[i] * curve.lag[i];
    EXPECT_NEAR(curve.total[i], 25 * t2, 1e-8 * t2);
    EXPECT_NEAR(curve.along[i], along * along * t2, 1e-8 * t2);
    EXPECT_NEAR(curve.across[i], across * across * t2, 1e-8 * t2);
  }
}

// The slow twin keeps all frames and averages over the origins 0, 2^k, 2 * 2^k, ... that level k uses.
TEST(MeanSquareDisplacement, EqualsTheSumOverAllFrames) {
  constexpr double kTheta = -1.1;
  Draw draw(71);
  const Frames frames = walks(draw, 5, 200, kTheta, 1.0, 0.3);
  MeanSquareDisplacement msd(1.0, 5);
  for (const std::vector<Vec3>& frame : frames) msd.accumulate(frame, std::vector<Vec3>(5, axis(kTheta)));
  const MsdCurve curve = msd.reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const auto lag = static_cast<std::size_t>(curve.lag[i]);
    std::size_t spacing = 1;
    while (lag > 8 * spacing) spacing *= 2;
    double along = 0, across = 0, n = 0;
    for (std::size_t origin = 0; origin + lag < frames.size(); origin += spacing) {
      for (std::size_t rod = 0; rod < 5; ++rod) {
        const Vec3 d = frames[origin + lag][rod] - frames[origin][rod];
        along += std::pow(d.x() * std::cos(kTheta) + d.y() * std::sin(kTheta), 2);
        across += std::pow(d.y() * std::cos(kTheta) - d.x() * std::sin(kTheta), 2);
        n += 1;
      }
    }
    EXPECT_NEAR(curve.along[i], along / n, 1e-10 * along);
    EXPECT_NEAR(curve.across[i], across / n, 1e-10 * along);
    EXPECT_NEAR(curve.total[i], (along + across) / n, 1e-10 * along);
  }
}

// Known answer 2 D t per axis, with 2 D = step^2 per frame. A mean of squares over N rods has relative error sqrt(2 /
// N) at worst (origins add only to it): |z| < 4.5 over all lags. Exchanged axes are off by a factor of four.
TEST(MeanSquareDisplacement, OfRandomWalksIsLinear) {
  constexpr std::size_t kRods = 1000;
  constexpr double kTheta = 0.8;
  Draw draw(72);
  MeanSquareDisplacement msd(1.0);
  for (const std::vector<Vec3>& frame : walks(draw, kRods, 300, kTheta, 1.0, 0.5)) {
    msd.accumulate(frame, std::vector<Vec3>(kRods, axis(kTheta)));
  }
  const MsdCurve curve = msd.reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    EXPECT_LT(std::abs(curve.along[i] / curve.lag[i] - 1.0) / std::sqrt(2.0 / kRods), 4.5);
    EXPECT_LT(std::abs(curve.across[i] / curve.lag[i] / 0.25 - 1.0) / std::sqrt(2.0 / kRods), 4.5);
  }
}

TEST(MeanSquareDisplacement, RefersToTheDirectorAtTheOriginTime) {
  MeanSquareDisplacement msd(1.0);
  msd.accumulate(std::vector<Vec3>{{0, 0, 0}}, std::vector<Vec3>{axis(0)});
  msd.accumulate(std::vector<Vec3>{{2, 0, 0}}, std::vector<Vec3>{axis(kPi / 2)});
  EXPECT_NEAR(msd.reduce().along[0], 4.0, 1e-14);
  EXPECT_NEAR(msd.reduce().across[0], 0.0, 1e-14);
  EXPECT_THROW(msd.accumulate(std::vector<Vec3>(2, Vec3::Zero()), std::vector<Vec3>(2, axis(0))), std::logic_error);
}

TEST(MeanSquareDisplacement, GoesOnBitwiseFromItsSavedState) {
  Draw draw(73);
  const std::vector<Vec3> directors = random_axes(draw, 4);
  MeanSquareDisplacement straight(0.1, 4), stopped(0.1, 4);
  int i = 0;
  for (const std::vector<Vec3>& frame : walks(draw, 4, 90, 0.2, 1.0, 1.0)) {
    straight.accumulate(frame, directors);
    stopped.accumulate(frame, directors);
    if (++i % 7 == 0) stop_and_go_on(stopped);
  }
  EXPECT_EQ(state(straight), state(stopped));
  expect_every_truncation_found(stopped);
  const std::vector<std::byte> bytes = state(straight);
  MeanSquareDisplacement of_other_interval(0.2, 4), of_other_levels(0.1, 5);
  StateReader first(bytes), second(bytes);
  EXPECT_THROW(of_other_interval.restore(first), StateError);
  EXPECT_THROW(of_other_levels.restore(second), StateError);
}

}  // namespace
}  // namespace shaken::analysis
