#include "analysis/tilt.h"

#include <gtest/gtest.h>

#include "analysis/errors/blocked.h"
#include "analysis/errors/parts.h"
#include "tests/unit/analysis/analysis_samples.h"

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

/// All samples of `blocked`, with errors.
TiltCurve curve_of(const Blocked<TiltVelocity>& blocked) {
  return TiltVelocity::reduce(blocked.empty(), blocked.parts_after(0.0, kMostParts));
}

// Every bin's z against the planted law, over 40 runs whose stretches are merged three times on the way. The mean of
// z^2 of 40 * 16 bins is 1 within 6 % by chance, for either component. A wrong sign of either, or division by |n| in
// place of |n_xy|, is off by tens of z; errors taken from the last stretches only give 6 to 11.
TEST(TiltVelocity, FindsThePlantedLawWithinItsErrors) {
  constexpr int kRuns = 40;
  Draw draw(31);
  std::vector<Vec3> directors, velocities;
  double along = 0, across = 0;
  for (int run = 0; run < kRuns; ++run) {
    Blocked<TiltVelocity> tilt{TiltVelocity(16, kMaxTilt)};
    for (int i = 0; i < 500; ++i) {
      planted(draw, 100, directors, velocities);
      tilt.accumulate(i, directors, velocities);
    }
    const TiltCurve curve = curve_of(tilt);
    ASSERT_EQ(curve.n_z.size(), 16u);
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_NEAR(curve.n_z[i], -kMaxTilt + (static_cast<double>(i) + 0.5) * kMaxTilt / 8, 1e-14);
      // The law changes by 3 * 0.05 within a bin, which adds 0.04^2 to the variance of one velocity.
      const double z_along = (curve.v_along[i] + kSlope * curve.n_z[i]) / curve.v_along_sem[i];
      const double z_across = (curve.v_across[i] - kAcross) / curve.v_across_sem[i];
      EXPECT_NEAR(curve.density[i], 1 / (2 * kMaxTilt), 4.5 / (2 * kMaxTilt) / std::sqrt(50000.0 / 16));
      along += z_along * z_along / (16 * kRuns);
      across += z_across * z_across / (16 * kRuns);
    }
  }
  EXPECT_NEAR(along, 1.0, 0.2);
  EXPECT_NEAR(across, 1.0, 0.2);
}

// Noise common to all rods, with correlation from call to call (a = 0.9, g = 19): the error of the mean is
// sqrt(g / calls). Of 60 runs of 421 independent samples each the mean of z^2 is 1 within 18 % by chance, and the mean
// of the errors' squares is good to 3 %. Taken as independent the samples would give errors sqrt(19 * 50) times too
// small.
TEST(TiltVelocity, ErrorsCountCorrelatedSamplesOnce) {
  constexpr int kCalls = 8000, kRuns = 60;
  Draw draw(32);
  double squares = 0, errors = 0;
  const std::vector<Vec3> directors{axis(0.1), axis(1.2), axis(2.3)};
  std::vector<Vec3> velocities(3);
  for (int run = 0; run < kRuns; ++run) {
    Blocked<TiltVelocity> tilt{TiltVelocity(1, kMaxTilt)};
    double time = 0;
    for (const double common : ar1(draw, 0.9, kCalls)) {
      for (std::size_t i = 0; i < 3; ++i) velocities[i] = common * directors[i];
      tilt.accumulate(time++, directors, velocities);
    }
    const TiltCurve curve = curve_of(tilt);
    squares += std::pow(curve.v_along[0] / curve.v_along_sem[0], 2) / kRuns;
    errors += std::pow(curve.v_along_sem[0], 2) / kRuns;
    EXPECT_NEAR(curve.v_across[0], 0.0, 1e-12);
  }
  EXPECT_NEAR(squares, 1.0, 0.5);
  EXPECT_NEAR(errors / (19.0 / kCalls), 1.0, 0.2);
}

TEST(TiltVelocity, EdgesOutsideAndUpright) {
  TiltVelocity tilt(4, kMaxTilt);
  const std::vector<Vec3> directors{
      {std::sqrt(1 - 0.16), 0, 0.4}, {std::sqrt(1 - 0.16), 0, -0.4}, axis(0, 0.5), {0, 0, 1}};
  tilt.accumulate(directors, std::vector<Vec3>(4, Vec3(2, 1, 0)));
  const TiltCurve curve = TiltVelocity::reduce(TiltVelocity(4, kMaxTilt), {tilt});
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
  const TiltMeans a = tilt.means(), b = flipped.means();
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(a.v_along[i], -b.v_along[7 - i], 1e-12);
    EXPECT_NEAR(a.v_across[i], -b.v_across[7 - i], 1e-12);
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
  const TiltMeans a = first.means(), b = both.means();
  EXPECT_EQ(a.density, b.density);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(a.v_along[i], b.v_along[i], 1e-12);
  }
  EXPECT_THROW(first.merge(TiltVelocity(8, 0.3)), std::logic_error);
}

// Bins that few blocks met say nothing of their scatter, and no samples nothing at all.
TEST(TiltVelocity, FewBlocksHaveNoErrors) {
  Draw draw(36);
  const TiltVelocity empty(2, kMaxTilt);
  std::vector<TiltVelocity> blocks(30, empty);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    blocks[b].accumulate(std::vector<Vec3>{axis(0, 0.1)}, std::vector<Vec3>{Vec3(draw.normal(), 0, 0)});
    if (b % 6 != 0) continue;
    blocks[b].accumulate(std::vector<Vec3>{axis(0, -0.1)}, std::vector<Vec3>{Vec3(draw.normal(), 0, 0)});
  }
  const TiltCurve curve = TiltVelocity::reduce(empty, blocks);
  EXPECT_GT(curve.v_along_sem[1], 0);
  EXPECT_TRUE(std::isfinite(curve.v_along[0]));
  EXPECT_TRUE(std::isnan(curve.v_along_sem[0]));
  EXPECT_EQ(blocks_met(blocks), (std::vector<std::size_t>{5, 30}));
  EXPECT_TRUE(std::isnan(TiltVelocity::reduce(empty, {}).v_along[0]));
  EXPECT_TRUE(std::isnan(TiltVelocity::reduce(empty, {}).v_along_sem[0]));
}

}  // namespace
}  // namespace shaken::analysis
