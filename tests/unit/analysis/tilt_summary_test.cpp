#include "analysis/tilt_summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

/// -v0 sin(pi n_z / 0.3): largest at 0.15, zero at 0.3, the other sign beyond; curve up to n_z = 0.4 of 40 bins.
constexpr double kSpeed = 5.0;
double law(double n_z) { return -kSpeed * std::sin(std::numbers::pi * n_z / 0.3); }

constexpr std::size_t kBlocks = 40;

/// `noise`: spread of one rod's velocity; samples of 400 rods, in as many blocks at most.
TiltSummary measured(Draw& draw, double noise, std::size_t samples, double (*of)(double) = law) {
  const TiltVelocity empty(40, 0.4);
  std::vector<TiltVelocity> blocks(std::min(kBlocks, samples), empty);
  for (std::size_t i = 0; i < samples; ++i) {
    std::vector<Vec3> directors, velocities;
    for (int rod = 0; rod < 400; ++rod) {
      const double n_z = draw.uniform(-0.4, 0.4), v = of(n_z) + noise * draw.normal();
      directors.push_back(axis(0.01 * rod, n_z));
      velocities.push_back({v * std::cos(0.01 * rod), v * std::sin(0.01 * rod), 0});
    }
    blocks[i * blocks.size() / samples].accumulate(directors, velocities);
  }
  return summarize_tilt(empty, blocks);
}

/// A rod of in-plane direction x.
void add(TiltVelocity& to, double n_z, double v) {
  to.accumulate(std::vector<Vec3>{axis(0, n_z)}, std::vector<Vec3>{Vec3(v, 0, 0)});
}

// Folding weighs each side with its samples; it is no mean of magnitudes. A bin is met where either side is.
TEST(TiltSummary, FoldsByTheSymmetryOfTheLabel) {
  const TiltVelocity empty(5, 0.25);  // bins at -0.2, -0.1, 0, 0.1, 0.2
  std::vector<TiltVelocity> blocks(10, empty);
  for (std::size_t b = 0; b < 10; ++b) {
    const double wave = b % 2 == 0 ? 0.1 : -0.1;
    add(blocks[b], 0.0, 7);
    for (int i = 0; i < 3; ++i) add(blocks[b], 0.1, -2 + wave);
    add(blocks[b], -0.1, 1 - wave);
    add(blocks[b], -0.2, 3 + wave);
  }
  const FoldedTilt folded = summarize_tilt(empty, blocks).folded;
  ASSERT_EQ(folded.n_z.size(), 2u);
  EXPECT_NEAR(folded.n_z[0], 0.1, 1e-12);
  EXPECT_NEAR(folded.v_along[0].value, (-2.0 * 3 - 1.0) / 4, 1e-12);
  EXPECT_NEAR(folded.v_along[1].value, -3.0, 1e-12);
  // The sides are of one block: what they share counts once. Each block is off by 0.1, to alternate sides.
  EXPECT_NEAR(folded.v_along[0].sem, 0.1 / 3, 1e-12);
  EXPECT_NEAR(folded.v_along[1].sem, 0.1 / 3, 1e-12);
  EXPECT_NEAR(folded.density[0] / folded.density[1], 4.0, 1e-12);
}

TEST(TiltSummary, FindsThePlantedPeakAndZero) {
  Draw draw(121);
  const TiltSummary summary = measured(draw, 1.0, 500);
  EXPECT_NEAR(summary.n_z_largest.value, 0.15, 0.021) << "a bin";
  EXPECT_GE(summary.n_z_largest.sem, 0.02 / std::sqrt(12.0) * (1 - 1e-9)) << "never less than a bin";
  EXPECT_LT(summary.n_z_largest.sem, 0.02);
  EXPECT_NEAR(summary.v_largest.value, -kSpeed, 4.5 * summary.v_largest.sem + 0.02);
  EXPECT_LT(summary.v_largest.sem, 0.03);
  EXPECT_NEAR(summary.n_z_zero.value, 0.3, 0.002);
  // The bin mean of -v0 sin over 0.3 .. 0.4 is v0 (1 - cos(pi / 3)) / (pi / 3) = 2.4; 50 000 samples of spread 1
  EXPECT_GT(summary.zero_sigma, 200);
}

// Of 100 runs: the mean of z^2 is 1 within 14 % by chance, which is allowed three times. The zero of the interpolation
// is off by less than 1e-4 for the curve's bend.
TEST(TiltSummary, ErrorsOfTheZeroAndOfTheCurveCoverTheTruth) {
  constexpr int kRuns = 100;
  Draw draw(124);
  double zero = 0, curve = 0, n = 0;
  for (int run = 0; run < kRuns; ++run) {
    const TiltSummary summary = measured(draw, 2.0, 80);
    zero += std::pow((summary.n_z_zero.value - 0.3) / summary.n_z_zero.sem, 2) / kRuns;
    for (std::size_t i = 0; i < summary.folded.n_z.size(); ++i) {
      const Estimate& v = summary.folded.v_along[i];
      // The mean of the law over the bin
      const double k = std::numbers::pi / 0.3, x = summary.folded.n_z[i];
      const double truth = law(x) * std::sin(k * 0.01) / (k * 0.01);
      curve += std::pow((v.value - truth) / v.sem, 2);
      n += 1;
    }
  }
  EXPECT_NEAR(zero, 1.0, 0.42);
  EXPECT_NEAR(curve / n, 1.0, 0.2);
}

// v = -v0 for all n_z > 0 has no zero but by noise, which is not significant.
double no_reversal(double n_z) { return std::abs(n_z) < 0.1 ? -20 * n_z : 0.0; }
TEST(TiltSummary, NoiseIsNoCrossing) {
  Draw draw(122);
  int beyond_four = 0;
  for (int repeat = 0; repeat < 50; ++repeat) {
    const TiltSummary summary = measured(draw, 1.0, 40, no_reversal);
    EXPECT_LT(summary.n_z_largest.value, 0.1);
    EXPECT_LT(summary.v_largest.value, 0);
    if (summary.zero_sigma > 4.5) ++beyond_four;
  }
  EXPECT_EQ(beyond_four, 0);
}

// One rod in two hundred is tilted farthest and goes ten times as fast: it is not what rods do.
TEST(TiltSummary, TheFastestBinHasOneSampleInAHundred) {
  for (const int among : {50, 200}) {
    const TiltVelocity empty(5, 0.25);  // bins at -0.2, -0.1, 0, 0.1, 0.2
    std::vector<TiltVelocity> blocks(10, empty);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const double wave = b % 2 == 0 ? 0.1 : -0.1;
      for (int i = 1; i < among; ++i) add(blocks[b], 0.1, -1 + wave);
      add(blocks[b], 0.2, -10 + wave);
    }
    const TiltSummary summary = summarize_tilt(empty, blocks);
    EXPECT_NEAR(summary.v_largest.value, among < 100 ? -10 : -1, 1e-12);
    EXPECT_NEAR(summary.n_z_largest.value, among < 100 ? 0.2 : 0.1, 1e-12);
  }
}

TEST(TiltSummary, OfNothingIsUnknown) {
  const TiltVelocity empty(8, 0.4);
  EXPECT_TRUE(std::isnan(summarize_tilt(empty, {}).v_largest.value));
  EXPECT_TRUE(std::isnan(summarize_tilt(empty, {empty, empty}).n_z_zero.value));
  Draw draw(123);
  EXPECT_TRUE(std::isnan(measured(draw, 1.0, 9).v_largest.value)) << "nine blocks have no errors";
}

}  // namespace
}  // namespace shaken::analysis
