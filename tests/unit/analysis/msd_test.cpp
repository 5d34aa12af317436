#include "analysis/msd.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/walks.h"

namespace shaken::analysis {
namespace {

MeanSquareDisplacement msd_of(const Frames& frames, double director, double interval = 1.0, int n_levels = 16) {
  MeanSquareDisplacement msd(interval, frames.front().size(), n_levels);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    msd.accumulate(static_cast<double>(i) * interval, frames[i], director);
  }
  return msd;
}

TEST(MeanSquareDisplacement, LagsAreFourAnOctave) {
  EXPECT_TRUE(MeanSquareDisplacement(0.5, 1, 3).reduce().lag.empty());
  const MsdCurve curve = msd_of(Frames(100, std::vector<Vec3>(2, Vec3::Zero())), 0, 0.5, 3).reduce();
  EXPECT_EQ(curve.lag, (std::vector<double>{0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 10, 12, 14, 16}));
  EXPECT_EQ(curve.total.value, std::vector<double>(16, 0.0));
}

TEST(MeanSquareDisplacement, OfFlightIsTheSquareOfTheWay) {
  const double theta = 0.6;
  Frames frames;
  for (int i = 0; i < 300; ++i) {
    // Far from the origin: sums of squares of whole positions would lose eight digits.
    frames.push_back({{1e4 + 3.0 * 0.1 * i, 4.0 * 0.1 * i, 0}});
  }
  const MsdCurve curve = msd_of(frames, theta, 0.1, 6).reduce();
  const double along = 3 * std::cos(theta) + 4 * std::sin(theta), across = 4 * std::cos(theta) - 3 * std::sin(theta);
  ASSERT_EQ(curve.lag.size(), 8u + 5 * 4);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const double t2 = curve.lag[i] * curve.lag[i];
    EXPECT_NEAR(curve.total.value[i], 25 * t2, 1e-8 * t2);
    EXPECT_NEAR(curve.along.value[i], along * along * t2, 1e-8 * t2);
    EXPECT_NEAR(curve.across.value[i], across * across * t2, 1e-8 * t2);
    EXPECT_TRUE(std::isnan(curve.relative_total.value[i])) << "of a single rod";
    EXPECT_NEAR(curve.exponent.value[i], 2, 1e-8);
  }
}

// The slow twin keeps all frames and averages over the origins 0, 2^k, 2 * 2^k, ... that level k uses.
TEST(MeanSquareDisplacement, EqualsTheSumOverAllFrames) {
  constexpr double kTheta = -1.1;
  Draw draw(71);
  const Frames frames = walks(draw, 5, 200, kTheta, 1.0, 0.3);
  const Vec3 n(std::cos(kTheta), std::sin(kTheta), 0), m(-std::sin(kTheta), std::cos(kTheta), 0);
  const MsdCurve curve = msd_of(frames, kTheta, 1.0, 5).reduce();
  ASSERT_EQ(curve.lag.size(), 8u + 4 * 4);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const auto lag = static_cast<std::size_t>(curve.lag[i]);
    double along = 0, across = 0, relative_along = 0, relative_across = 0, pairs = 0;
    for (std::size_t origin = 0; origin + lag < frames.size(); origin += origin_spacing(lag)) {
      Vec3 drift = Vec3::Zero();
      for (std::size_t rod = 0; rod < 5; ++rod) drift += (frames[origin + lag][rod] - frames[origin][rod]) / 5;
      for (std::size_t rod = 0; rod < 5; ++rod) {
        const Vec3 d = frames[origin + lag][rod] - frames[origin][rod];
        along += std::pow(d.dot(n), 2);
        across += std::pow(d.dot(m), 2);
        relative_along += std::pow((d - drift).dot(n), 2) * 5 / 4;
        relative_across += std::pow((d - drift).dot(m), 2) * 5 / 4;
        pairs += 1;
      }
    }
    const double tolerance = 1e-12 * along;
    EXPECT_NEAR(curve.along.value[i], along / pairs, tolerance);
    EXPECT_NEAR(curve.across.value[i], across / pairs, tolerance);
    EXPECT_NEAR(curve.total.value[i], (along + across) / pairs, tolerance);
    EXPECT_NEAR(curve.relative_along.value[i], relative_along / pairs, tolerance);
    EXPECT_NEAR(curve.relative_across.value[i], relative_across / pairs, tolerance);
    EXPECT_NEAR(curve.relative_total.value[i], (relative_along + relative_across) / pairs, tolerance);
  }
}

// Known answer 2 D t per axis, with 2 D = step^2 per frame. A mean of squares over N rods has relative error sqrt(2 /
// N) at worst (origins add only to it): |z| < 4.5 over all lags. Exchanged axes are off by a factor of four.
TEST(MeanSquareDisplacement, OfRandomWalksIsLinear) {
  constexpr std::size_t kRods = 1000;
  constexpr double kTheta = 0.8;
  Draw draw(72);
  const MsdCurve curve = msd_of(walks(draw, kRods, 300, kTheta, 1.0, 0.5), kTheta).reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    EXPECT_LT(std::abs(curve.along.value[i] / curve.lag[i] - 1.0) / std::sqrt(2.0 / kRods), 4.5);
    EXPECT_LT(std::abs(curve.across.value[i] / curve.lag[i] / 0.25 - 1.0) / std::sqrt(2.0 / kRods), 4.5);
  }
}

TEST(MeanSquareDisplacement, RefersToTheDirectorAtTheOriginTime) {
  MeanSquareDisplacement msd(1.0, 1);
  msd.accumulate(0, std::vector<Vec3>{{0, 0, 0}}, 0);
  msd.accumulate(1, std::vector<Vec3>{{2, 0, 0}}, kPi / 2);
  EXPECT_NEAR(msd.reduce().along.value[0], 4.0, 1e-14);
  EXPECT_NEAR(msd.reduce().across.value[0], 0.0, 1e-14);
  EXPECT_TRUE(std::isnan(msd.reduce().along.sem[0]));
  EXPECT_THROW(msd.accumulate(2, std::vector<Vec3>(2, Vec3::Zero()), 0), std::logic_error);
  EXPECT_THROW(msd.accumulate(3, std::vector<Vec3>(1, Vec3::Zero()), 0), std::logic_error) << "one was left out";
}

// A common drift of 0.1 a sample on walks with steps of 1 in each direction: over 64 samples it adds 41 to 128.
// Without it nothing is lacking.
TEST(MeanSquareDisplacement, RelativeMotionIsFreeOfTheDriftOfTheWhole) {
  Draw draw(74);
  Frames still = walks(draw, 25, 2000, 0, 1.0, 1.0), drifting = still;
  for (std::size_t i = 0; i < drifting.size(); ++i) {
    for (Vec3& r : drifting[i]) r += 0.1 * static_cast<double>(i) * Vec3(0.6, 0.8, 0);
  }
  const MsdCurve a = msd_of(still, 0).reduce(), b = msd_of(drifting, 0).reduce();
  for (std::size_t i = 0; i < a.lag.size() && a.lag[i] <= 64; ++i) {
    EXPECT_NEAR(a.relative_total.value[i], b.relative_total.value[i], 1e-8 * a.lag[i]);
    EXPECT_NEAR(a.relative_total.value[i] / a.total.value[i], 1, 0.03);
    if (a.lag[i] == 64) {
      EXPECT_GT(b.total.value[i], 1.25 * a.total.value[i]);
    }
  }
}

// Of few rods that know nothing of each other diffusion without the drift of all is the same: 4 D t with 4 D = 2 a
// sample in the plane. Over 20,000 samples of three rods its error at a lag of one is 2 sqrt(1 / (2 20,000)).
TEST(MeanSquareDisplacement, RelativeMotionOfFewRodsIsThatOfMany) {
  for (const int n_rods : {2, 3}) {
    Draw draw(75);
    const MsdCurve curve = msd_of(walks(draw, n_rods, 20000, 0, 1.0, 1.0), 0).reduce();
    EXPECT_NEAR(curve.relative_total.value[0], 2, 4.5 * 2 * std::sqrt(1 / (2 * 20000.0))) << n_rods;
    EXPECT_NEAR(curve.relative_along.value[0], 1, 4.5 * std::sqrt(2 / 20000.0)) << n_rods;
  }
}

// "auto": the steady part is known only afterwards. Origins count from the next stretch on; here of 1000 samples in
// stretches of 16 the origins from 512 on.
TEST(MeanSquareDisplacement, CountsOriginsFromTheSteadyTimeOn) {
  Draw draw(75);
  Frames frames = walks(draw, 3, 1000, 0, 1.0, 1.0);
  for (std::size_t i = 0; i < 500; ++i) frames[i][1] *= 100.0;  // wild before
  const MsdCurve curve = msd_of(frames, 0).reduce(500);
  ASSERT_GT(curve.lag.size(), 20u);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const auto lag = static_cast<std::size_t>(curve.lag[i]), spacing = origin_spacing(lag);
    double sum = 0, pairs = 0;
    for (std::size_t origin = (512 + spacing - 1) / spacing * spacing; origin + lag < 1000; origin += spacing) {
      for (std::size_t rod = 0; rod < 3; ++rod) sum += (frames[origin + lag][rod] - frames[origin][rod]).squaredNorm();
      pairs += 3;
    }
    EXPECT_NEAR(curve.total.value[i], sum / pairs, 1e-12 * sum) << lag;
  }
}

// chi^2 / n of 200 repeated experiments of 20 rods: 10 % itself with many stretches. At the longest lags, up to a sixth
// of the run, there are but five, whose chi^2 has no variance: there 95 of 100 results must lie within two errors.
TEST(MeanSquareDisplacement, ErrorsAreTheScatterOfRepeatedExperiments) {
  Draw draw(76);
  constexpr int kRepeats = 200;
  std::vector<double> chi2, lags;
  std::vector<double> within_two;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const MsdCurve curve = msd_of(walks(draw, 20, 700, 0, 1.0, 1.0), 0).reduce();
    chi2.resize(curve.lag.size());
    within_two.resize(curve.lag.size());
    lags = curve.lag;
    for (std::size_t i = 0; i < curve.lag.size(); ++i) {
      const double z = (curve.total.value[i] - 2 * curve.lag[i]) / curve.total.sem[i];
      chi2[i] += z * z / kRepeats;
      within_two[i] += std::abs(z) < 2 ? 1.0 / kRepeats : 0;
      EXPECT_DOUBLE_EQ(curve.d_total.value[i], curve.total.value[i] / (4 * curve.lag[i]));
      EXPECT_DOUBLE_EQ(curve.d_along.value[i], curve.along.value[i] / (2 * curve.lag[i]));
      EXPECT_EQ(curve.d_across.sem[i] > 0, curve.across.sem[i] > 0);
    }
  }
  for (std::size_t i = 0; i < lags.size(); ++i) {
    if (lags[i] <= 64) {
      EXPECT_NEAR(chi2[i], 1.0, 0.35) << lags[i];
    }
    if (lags[i] <= 112) {
      EXPECT_NEAR(within_two[i], 0.95, 0.045) << lags[i];
    } else {
      EXPECT_TRUE(std::isnan(chi2[i])) << "too few stretches of the lag";
    }
  }
}

TEST(MeanSquareDisplacement, NothingAndOneRodDoNotCrash) {
  const MeanSquareDisplacement none = msd_of(Frames(20), 0), one = msd_of(Frames(20, {Vec3(1, 2, 3)}), 0);
  EXPECT_TRUE(none.reduce().lag.empty());
  EXPECT_TRUE(std::isnan(none.diffusion().d_long.value));
  EXPECT_EQ(one.reduce().total.value[0], 0.0);
  EXPECT_TRUE(std::isnan(one.reduce().exponent.value[0]));
  EXPECT_TRUE(std::isnan(one.diffusion().d_relative.value));
  EXPECT_TRUE(one.reduce(1e9).lag.empty());
}

}  // namespace
}  // namespace shaken::analysis
