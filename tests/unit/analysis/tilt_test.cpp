#include "analysis/tilt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "analysis/errors/blocked.h"
#include "analysis/errors/jackknife.h"
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

// Bins at -0.2, -0.1, 0, 0.1, 0.2: the straight line from -4 at 0.1 to 1 at 0.2 is zero at 0.18. What moves both
// velocities by w moves it by 0.1 * 5 / 25 * w.
TEST(TiltSummary, TheZeroIsThatOfTheStraightLineBetweenBins) {
  const TiltVelocity empty(5, 0.25);
  std::vector<TiltVelocity> blocks(10, empty);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const double wave = b % 2 == 0 ? 0.01 : -0.01;
    add(blocks[b], 0.1, -4 + wave);
    add(blocks[b], 0.2, 1 + wave);
  }
  const TiltSummary summary = summarize_tilt(empty, blocks);
  EXPECT_NEAR(summary.n_z_zero.value, 0.18, 1e-6);
  EXPECT_NEAR(summary.n_z_zero.sem, 0.02 * 0.01 / 3, 1e-6);
  EXPECT_NEAR(summary.zero_sigma, 1 / (0.01 / 3), 1) << "of the mean beyond it";
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

Estimate time_of(const TiltSwitches& switches, double t_steady = 0) {
  return jackknife(switches.sums().empty(), switches.sums().parts_after(t_steady, kMostParts),
                   [](const SwitchSums& sums) { return std::vector{TiltSwitches::switching_time(sums)}; })[0];
}

TEST(TiltSwitches, CountWhatCrossesBothThresholds) {
  TiltSwitches switches(0.2);
  // Unknown, up (at 1 s), back between, down (3 s), on the threshold itself, down again, up (6 s).
  const double n_z[] = {0.1, 0.3, -0.1, -0.3, 0.2, -0.25, 0.21};
  for (int i = 0; i < 7; ++i) {
    // The other rod never leaves the middle, which is no side.
    switches.accumulate(i, std::vector<Vec3>{axis(0, n_z[i]), axis(0, 0.19 * (i % 2 == 0 ? 1 : -1))});
  }
  const SwitchSums sums = switches.sums().all();
  EXPECT_EQ(sums.switches, 2);
  EXPECT_EQ(sums.lived, 5);
  EXPECT_EQ(TiltSwitches::switching_time(sums), 2.5);
  EXPECT_TRUE(std::isnan(TiltSwitches::switching_time(SwitchSums{})));
  EXPECT_THROW(switches.accumulate(6, std::vector<Vec3>(2)), std::logic_error);
  EXPECT_THROW(switches.accumulate(7, std::vector<Vec3>(3)), std::logic_error);
}

// A rod that changes sides with probability p a sample stays 1 / p samples on average. 300 experiments: chi^2 / n of
// the errors, good to 8 % itself.
TEST(TiltSwitches, OfATelegraphWithItsError) {
  constexpr double kP = 0.05, kInterval = 0.01;
  constexpr int kRepeats = 300;
  Draw draw(131);
  double chi2 = 0, sum = 0, squares = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    TiltSwitches switches(0.2);
    std::vector<double> side(5, 1);
    for (int i = 0; i < 1600; ++i) {
      std::vector<Vec3> directors;
      for (double& s : side) {
        if (draw.uniform(0, 1) < kP) s = -s;
        directors.push_back(axis(0, 0.3 * s));
      }
      switches.accumulate(kInterval * i, directors);
    }
    const Estimate time = time_of(switches);
    const double off = time.value - kInterval / kP;
    chi2 += std::pow(off / time.sem, 2);
    sum += off;
    squares += off * off;
  }
  // A ratio is above its mean by its relative variance: 1 / 400 switches.
  EXPECT_LT(std::abs(sum - kRepeats * kInterval / kP / 400) / std::sqrt(squares), 4.5);
  EXPECT_GT(chi2 / kRepeats, 0.8);
  EXPECT_LT(chi2 / kRepeats, 1.35);
}

TEST(LargestTilt, IsSetByTheGap) {
  // The end beads touch both plates: half_length * n_z + end_radius = gap / 2.
  EXPECT_NEAR(largest_tilt(2.0, 0.2, 1.2), (0.6 - 0.2) / 2.0, 1e-12);
  EXPECT_EQ(largest_tilt(2.0, 0.2, 100), 1);
  EXPECT_EQ(largest_tilt(2.0, 0.2, 0.3), 0);
  EXPECT_EQ(largest_tilt(0.0, 0.2, 1.2), 1) << "a sphere may point anywhere";
}

}  // namespace
}  // namespace shaken::analysis
