// SPDX-License-Identifier: MIT
#include "analysis/tilt.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

constexpr double kMaxTilt = 0.4;

/// One instant of rods of any in-plane direction whose centre moves along themselves with -kSlope n_z and across with
/// kAcross, each plus noise of unit spread.
constexpr double kSlope = 3.0, kAcross = 0.5;
void planted(Draw& draw, std::size_t n, std::vector<Vec3>& directors, std::vector<Vec3>& velocities) {
  directors.clear();
  velocities.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = draw.uniform(-kPi, kPi), n_z = draw.uniform(-kMaxTilt, kMaxTilt);
    const double along = -kSlope * n_z + draw.normal(), across = kAcross + draw.normal();
    directors.push_back(axis(theta, n_z));
    velocities.push_back(
        {along * std::cos(theta) - across * std::sin(theta), along * std::sin(theta) + across * std::cos(theta), 7.0});
  }
}

// Every bin's z against the planted law. Sixteen bins twice: max |z| < 4.5, and the sum of z^2 is chi-square up to the
// scatter of errors taken from 20 to 40 blocks. A wrong sign of either component, or division by |n| in place of
// |n_xy|, is off by tens of z.
TEST(TiltVelocity, FindsThePlantedLaw) {
  Draw draw(31);
  TiltVelocity tilt(16, kMaxTilt);
  std::vector<Vec3> directors, velocities;
  for (int i = 0; i < 500; ++i) {
    planted(draw, 200, directors, velocities);
    tilt.accumulate(directors, velocities);
  }
  const TiltCurve curve = tilt.reduce();
  ASSERT_EQ(curve.n_z.size(), 16u);
  double sum = 0;
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(curve.n_z[i], -kMaxTilt + (static_cast<double>(i) + 0.5) * kMaxTilt / 8, 1e-14);
    const double z_along = (curve.v_along[i] + kSlope * curve.n_z[i]) / curve.v_along_sem[i];
    const double z_across = (curve.v_across[i] - kAcross) / curve.v_across_sem[i];
    EXPECT_LT(std::abs(z_along), 4.5);
    EXPECT_LT(std::abs(z_across), 4.5);
    EXPECT_NEAR(curve.density[i], 1 / (2 * kMaxTilt), 4.5 / (2 * kMaxTilt) / std::sqrt(100000.0 / 16));
    EXPECT_NEAR(curve.v_along_sem[i], 1 / std::sqrt(100000.0 / 16), 0.65 / std::sqrt(100000.0 / 16));
    sum += z_along * z_along + z_across * z_across;
  }
  EXPECT_LT(sum, 32 + 4 * std::sqrt(64.0) * 1.3);
}

// Noise common to all rods, with correlation from call to call (a = 0.9, g = 19): the error of the mean is
// sqrt(g / calls). Errors from 20 to 40 blocks scatter by 16 %, so 4 z is 65 %. Taken as independent the samples would
// give an error sqrt(19 * 50) times too small.
TEST(TiltVelocity, ErrorsCountCorrelatedSamplesOnce) {
  constexpr int kCalls = 8000;
  Draw draw(32);
  TiltVelocity tilt(1, kMaxTilt);
  for (const double common : ar1(draw, 0.9, kCalls)) {
    std::vector<Vec3> directors, velocities;
    for (int i = 0; i < 50; ++i) {
      directors.push_back(axis(0.1 * i));
      velocities.push_back(common * directors.back());
    }
    tilt.accumulate(directors, velocities);
  }
  const double truth = std::sqrt(19.0 / kCalls);
  const TiltCurve curve = tilt.reduce();
  EXPECT_NEAR(curve.v_along_sem[0], truth, 0.65 * truth);
  EXPECT_LT(std::abs(curve.v_along[0]) / truth, 4.0);
  EXPECT_NEAR(curve.v_across[0], 0.0, 1e-12);
}

TEST(TiltVelocity, EdgesOutsideAndUpright) {
  TiltVelocity tilt(4, kMaxTilt);
  const std::vector<Vec3> directors{
      {std::sqrt(1 - 0.16), 0, 0.4}, {std::sqrt(1 - 0.16), 0, -0.4}, axis(0, 0.5), {0, 0, 1}};
  tilt.accumulate(directors, std::vector<Vec3>(4, Vec3(2, 1, 0)));
  const TiltCurve curve = tilt.reduce();
  EXPECT_EQ(curve.v_along[0], 2.0);
  EXPECT_EQ(curve.v_along[3], 2.0);
  EXPECT_EQ(curve.v_across[3], 1.0);
  EXPECT_TRUE(std::isnan(curve.v_along[1]));
  EXPECT_TRUE(std::isnan(curve.v_along_sem[0]));        // one block says nothing about the error
  EXPECT_NEAR(curve.density[3], 1 / (3 * 0.2), 1e-12);  // of three samples with an in-plane direction
}

TEST(TiltVelocity, AFlippedLabelMirrorsTheCurve) {
  Draw draw(33);
  TiltVelocity tilt(8, kMaxTilt), flipped(8, kMaxTilt);
  std::vector<Vec3> directors, velocities;
  for (int i = 0; i < 5; ++i) {
    planted(draw, 300, directors, velocities);
    tilt.accumulate(directors, velocities);
    for (Vec3& n : directors) n = -n;
    flipped.accumulate(directors, velocities);
  }
  const TiltCurve a = tilt.reduce(), b = flipped.reduce();
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(a.v_along[i], -b.v_along[7 - i], 1e-12);
    EXPECT_NEAR(a.v_across[i], -b.v_across[7 - i], 1e-12);
    EXPECT_NEAR(a.v_along_sem[i], b.v_along_sem[7 - i], 1e-12);
  }
}

TEST(TiltVelocity, MergeKeepsMeansAndDensity) {
  Draw draw(34);
  TiltVelocity first(8, kMaxTilt), second(8, kMaxTilt), both(8, kMaxTilt);
  std::vector<Vec3> directors, velocities;
  for (int i = 0; i < 300; ++i) {
    planted(draw, 20, directors, velocities);
    (i < 100 ? first : second).accumulate(directors, velocities);
    both.accumulate(directors, velocities);
  }
  first.merge(second);
  const TiltCurve a = first.reduce(), b = both.reduce();
  EXPECT_EQ(a.density, b.density);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(a.v_along[i], b.v_along[i], 1e-12);
    EXPECT_NEAR(a.v_along_sem[i], b.v_along_sem[i], 0.8 * b.v_along_sem[i]);
  }
  EXPECT_THROW(first.merge(TiltVelocity(8, 0.3)), std::logic_error);
}

TEST(TiltVelocity, GoesOnBitwiseFromItsSavedState) {
  Draw draw(35);
  TiltVelocity straight(8, kMaxTilt), stopped(8, kMaxTilt);
  std::vector<Vec3> directors, velocities;
  for (int i = 0; i < 200; ++i) {
    planted(draw, 20, directors, velocities);
    straight.accumulate(directors, velocities);
    stopped.accumulate(directors, velocities);
    if (i % 13 == 0) stop_and_go_on(stopped);
  }
  EXPECT_EQ(state(straight), state(stopped));
  expect_every_truncation_found(stopped);
  const std::vector<std::byte> bytes = state(straight);
  StateReader reader(bytes);
  TiltVelocity other(8, 0.3);
  EXPECT_THROW(other.restore(reader), StateError);
}

}  // namespace
}  // namespace shaken::analysis
