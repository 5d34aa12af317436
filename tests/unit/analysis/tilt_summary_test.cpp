// SPDX-License-Identifier: MIT
#include "analysis/tilt_summary.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/unit/analysis/samples.h"

namespace shaken::analysis {
namespace {

/// -v0 sin(pi n_z / 0.3): largest at 0.15, zero at 0.3, the other sign beyond; curve up to n_z = 0.4 of 40 bins.
constexpr double kSpeed = 5.0;
double law(double n_z) { return -kSpeed * std::sin(std::numbers::pi * n_z / 0.3); }

/// `noise`: spread of one rod's velocity.
TiltCurve measured(Draw& draw, double noise, int samples, int bins = 40) {
  TiltVelocity tilt(bins, 0.4);
  for (int i = 0; i < samples; ++i) {
    std::vector<Vec3> directors, velocities;
    for (int rod = 0; rod < 400; ++rod) {
      const double n_z = draw.uniform(-0.4, 0.4), v = law(n_z) + noise * draw.normal();
      directors.push_back(axis(0.01 * rod, n_z));
      velocities.push_back({v * std::cos(0.01 * rod), v * std::sin(0.01 * rod), 0});
    }
    tilt.accumulate(directors, velocities);
  }
  return tilt.reduce();
}

// Folding takes twice the samples of one side: its error is smaller by sqrt(2), and it is no mean of magnitudes.
TEST(TiltSummary, FoldsByTheSymmetryOfTheLabel) {
  TiltCurve curve;
  curve.n_z = {-0.2, -0.1, 0, 0.1, 0.2};
  curve.v_along = {3, 1, 7, -2, NAN};
  curve.v_along_sem = {0.3, 0.1, 1, 0.1, NAN};
  curve.v_across = curve.v_across_sem = std::vector<double>(5);
  curve.density = {1, 2, 9, 6, 0};
  const FoldedTilt folded = fold_tilt(curve);
  EXPECT_EQ(folded.n_z, (std::vector<double>{0.1, 0.2}));
  EXPECT_DOUBLE_EQ(folded.v_along.value[0], (-2.0 * 6 - 1.0 * 2) / 8);
  EXPECT_DOUBLE_EQ(folded.v_along.sem[0], 0.1 * std::hypot(6, 2) / 8);
  EXPECT_DOUBLE_EQ(folded.v_along.value[1], -3.0);
  EXPECT_DOUBLE_EQ(folded.v_along.sem[1], 0.3);
  EXPECT_EQ(folded.density, (std::vector<double>{8, 1}));
}

TEST(TiltSummary, FindsThePlantedPeakAndZero) {
  Draw draw(121);
  const TiltSummary summary = summarize_tilt(measured(draw, 1.0, 500));
  EXPECT_NEAR(summary.n_z_largest, 0.15, 0.021) << "a bin";
  EXPECT_NEAR(summary.v_largest.value, -kSpeed, 4.5 * summary.v_largest.sem + 0.02);
  EXPECT_LT(summary.v_largest.sem, 0.03);
  EXPECT_NEAR(summary.n_z_zero, 0.3, 0.002);
  // The bin mean of -v0 sin over 0.3 .. 0.4 is v0 (1 - cos(pi / 3)) / (pi / 3) = 2.4; 50 000 samples of spread 1
  EXPECT_GT(summary.zero_sigma, 200);
}

// v = -v0 for all n_z > 0 has no zero but by noise, which is not significant.
TEST(TiltSummary, NoiseIsNoCrossing) {
  Draw draw(122);
  int beyond_four = 0;
  for (int repeat = 0; repeat < 50; ++repeat) {
    TiltVelocity tilt(40, 0.4);
    for (int i = 0; i < 80; ++i) {
      std::vector<Vec3> directors, velocities;
      for (int rod = 0; rod < 100; ++rod) {
        const double n_z = draw.uniform(-0.4, 0.4);
        const double v = (std::abs(n_z) < 0.1 ? -20 * n_z : 0.0) + draw.normal();
        directors.push_back(axis(0, n_z));
        velocities.push_back({v, 0, 0});
      }
      tilt.accumulate(directors, velocities);
    }
    const TiltSummary summary = summarize_tilt(tilt.reduce());
    EXPECT_LT(summary.n_z_largest, 0.1);
    EXPECT_LT(summary.v_largest.value, 0);
    if (summary.zero_sigma > 4.5) ++beyond_four;
  }
  EXPECT_EQ(beyond_four, 0);
}

TEST(TiltSummary, OfNothingIsUnknown) {
  EXPECT_TRUE(std::isnan(summarize_tilt({}).v_largest.value));
  EXPECT_TRUE(std::isnan(summarize_tilt(TiltVelocity(8, 0.4).reduce()).n_z_zero));
  Draw draw(123);
  EXPECT_TRUE(std::isnan(summarize_tilt(measured(draw, 1.0, 1)).v_largest.value)) << "one block has no errors";
}

}  // namespace
}  // namespace shaken::analysis
