#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "analysis/msd.h"
#include "analysis/rotation.h"
#include "analysis/van_hove.h"
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

// The slow twin keeps all frames and averages over the origins 0, 2^k, 2 * 2^k, ... that level k uses, and over the
// rods that are in both frames.
TEST(MeanSquareDisplacement, EqualsTheSumOverAllFrames) {
  constexpr double kTheta = -1.1;
  Draw draw(71);
  const Frames frames = with_holes(draw, walks(draw, 5, 200, kTheta, 1.0, 0.3));
  const Vec3 n(std::cos(kTheta), std::sin(kTheta), 0), m(-std::sin(kTheta), std::cos(kTheta), 0);
  const MsdCurve curve = msd_of(frames, kTheta, 1.0, 5).reduce();
  ASSERT_EQ(curve.lag.size(), 8u + 4 * 4);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const auto lag = static_cast<std::size_t>(curve.lag[i]);
    double along = 0, across = 0, relative_along = 0, relative_across = 0, pairs = 0;
    for (std::size_t origin = 0; origin + lag < frames.size(); origin += origin_spacing(lag)) {
      std::vector<Vec3> ways;
      for (std::size_t rod = 0; rod < 5; ++rod) {
        const Vec3 d = frames[origin + lag][rod] - frames[origin][rod];
        if (!d.hasNaN()) ways.push_back(d);
      }
      Vec3 drift = Vec3::Zero();
      for (const Vec3& d : ways) drift += d / static_cast<double>(ways.size());
      for (const Vec3& d : ways) {
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

TEST(DisplacementHistogram, CountsMagnitudesByHand) {
  DisplacementHistogram histogram(4, 2.0);  // bins of 0.5
  // along y: one forwards by 1.2, one back by 0.7, one too far
  histogram.accumulate(std::vector<Vec2>{{0.3, 1.2}, {0, -0.7}, {0.1, 5}}, kPi / 2);
  const DisplacementCurve curve = histogram.reduce();
  EXPECT_EQ(curve.displacement, (std::vector<double>{0.25, 0.75, 1.25, 1.75}));
  const double one = 1.0 / 3;  // of three rods, over two bins of 0.5 each
  EXPECT_EQ(curve.along, (std::vector<double>{0, one, one, 0}));
  EXPECT_NEAR(curve.across[0], 1, 1e-15);
  EXPECT_EQ(curve.distance, (std::vector<double>{0, 2 * one, 2 * one, 0}));
  EXPECT_NEAR(curve.beyond, one, 1e-15);
  EXPECT_TRUE(std::isnan(DisplacementHistogram(4, 1).reduce().along[0]));
  EXPECT_TRUE(std::isnan(DisplacementHistogram(4, 1).reduce().beyond));
}

// The slow twin keeps all frames; the director turns with time, and origins follow each other by one lag.
TEST(VanHove, EqualsTheCountOverAllFrames) {
  constexpr int kBins = 7;
  Draw draw(323);
  const Frames frames = with_holes(draw, walks(draw, 6, 101, 0, 1.0, 0.4));
  VanHove van_hove(0.5, 9.8, kBins, 4.0);  // lags of 20, 5 and 1 samples, the last twice
  for (std::size_t i = 0; i < frames.size(); ++i) {
    van_hove.accumulate(0.5 * static_cast<double>(i), frames[i], 0.03 * static_cast<double>(i));
  }
  ASSERT_EQ(van_hove.n_lags(), 3u);
  const std::size_t steps[] = {1, 5, 20};
  const double ranges[] = {0.5, 2, 4};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(van_hove.lag(k), 0.5 * static_cast<double>(steps[k]));
    std::vector<double> along(kBins), across(kBins);
    double rods = 0;
    for (std::size_t origin = 0; origin + steps[k] < frames.size(); origin += steps[k]) {
      const double theta = 0.03 * static_cast<double>(origin);
      for (std::size_t rod = 0; rod < 6; ++rod) {
        const Vec3 d = frames[origin + steps[k]][rod] - frames[origin][rod];
        if (d.hasNaN()) continue;
        rods += 1;
        for (std::size_t bin = 0; bin < kBins; ++bin) {
          const double from = ranges[k] / kBins * static_cast<double>(bin), to = from + ranges[k] / kBins;
          const double x = std::abs(d.dot(axis(theta))), y = std::abs(d.dot(axis(theta + kPi / 2)));
          along[bin] += x >= from && x < to ? 1 : 0;
          across[bin] += y >= from && y < to ? 1 : 0;
        }
      }
    }
    const DisplacementCurve curve = van_hove.displacements(k).all().reduce();
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      EXPECT_NEAR(curve.along[bin], along[bin] / rods / (2 * ranges[k] / kBins), 1e-12);
      EXPECT_NEAR(curve.across[bin], across[bin] / rods / (2 * ranges[k] / kBins), 1e-12);
    }
  }
  EXPECT_THROW(van_hove.accumulate(1e3, std::vector<Vec3>(1), 0), std::logic_error);
}

/// Angles of rods in rotational diffusion, sample by sample.
std::vector<std::vector<double>> turning(Draw& draw, std::size_t n_rods, std::size_t n, double step) {
  std::vector<std::vector<double>> angles(1);
  for (std::size_t i = 0; i < n_rods; ++i) angles[0].push_back(draw.uniform(-kPi, kPi));
  while (angles.size() < n) {
    std::vector<double> next = angles.back();
    for (double& theta : next) theta += step * draw.normal();
    angles.push_back(next);
  }
  return angles;
}

Rotation rotation_of(const std::vector<std::vector<double>>& angles, double interval = 1.0, int n_levels = 16) {
  Rotation rotation(interval, n_levels);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    std::vector<Vec3> directors;
    for (const double theta : angles[i]) directors.push_back(axis(theta, 0.2));
    rotation.accumulate(static_cast<double>(i) * interval, directors);
  }
  return rotation;
}

// The slow twin has the angles themselves, over many turns, and averages over the origins that level k uses. The
// director's label makes no difference.
TEST(Rotation, EqualsTheSumOverAllFrames) {
  Draw draw(101);
  auto angles = turning(draw, 5, 300, 0.2);
  for (auto& sample : angles) {
    for (double& angle : sample) angle = draw.uniform(0, 1) < 0.1 ? kNaN : angle;
  }
  auto relabelled = angles;
  for (std::size_t i = 0; i < relabelled.size(); i += 2) relabelled[i][3] += kPi;
  for (const Rotation& rotation : {rotation_of(angles), rotation_of(relabelled)}) {
    const RotationCurve curve = rotation.reduce();
    ASSERT_GT(curve.lag.size(), 20u);
    for (std::size_t i = 0; i < curve.lag.size(); ++i) {
      const auto lag = static_cast<std::size_t>(curve.lag[i]);
      double msad = 0, c2 = 0, pairs = 0;
      for (std::size_t origin = 0; origin + lag < angles.size(); origin += origin_spacing(lag)) {
        for (std::size_t rod = 0; rod < 5; ++rod) {
          const double turn = angles[origin + lag][rod] - angles[origin][rod];
          if (std::isnan(turn)) continue;  // it is missed in one of the two
          msad += turn * turn;
          c2 += std::cos(2 * turn);
          pairs += 1;
        }
      }
      EXPECT_NEAR(curve.msad.value[i], msad / pairs, 1e-11 * msad);
      EXPECT_NEAR(curve.c2.value[i], c2 / pairs, 1e-11);
    }
  }
}

// Known answers of rotational diffusion: MSAD = 2 D_r t, C_2 = exp(-4 D_r t), here with D_r = 0.5 step^2 / dt = 2
// rad^2/s. Of 26 lags all |z| < 4.5; errors are known to 13 % or so at best, from few stretches at the longest lags.
TEST(Rotation, OfRotationalDiffusion) {
  constexpr double kD = 2.0, kDt = 0.01;
  Draw draw(102);
  const Rotation rotation = rotation_of(turning(draw, 200, 3000, std::sqrt(2 * kD * kDt)), kDt);
  const RotationCurve curve = rotation.reduce();
  int tested = 0;
  for (std::size_t i = 0; i < curve.lag.size() && curve.lag[i] <= 3; ++i) {
    EXPECT_LT(std::abs(curve.msad.value[i] - 2 * kD * curve.lag[i]) / curve.msad.sem[i], 4.5) << curve.lag[i];
    EXPECT_LT(std::abs(curve.c2.value[i] - std::exp(-4 * kD * curve.lag[i])) / curve.c2.sem[i], 4.5) << curve.lag[i];
    EXPECT_LT(curve.msad.sem[i], 0.1 * curve.msad.value[i]);
    ++tested;
  }
  EXPECT_GT(tested, 25);
  const RotationSummary summary = rotation.summarize();
  EXPECT_LT(std::abs(summary.d_r.value - kD) / summary.d_r.sem, 4.5);
  EXPECT_LT(summary.d_r.sem, 0.1 * kD);
  EXPECT_LT(std::abs(summary.growth.at_short.exponent.value - 1) / summary.growth.at_short.exponent.sem, 4.5);
  EXPECT_LT(std::abs(summary.c2_decay_time.value - 1 / (4 * kD)) / summary.c2_decay_time.sem, 4.5);
  EXPECT_LT(summary.c2_decay_time.sem, 0.02 / (4 * kD));
  EXPECT_LT(std::abs(summary.c2_plateau.value) / summary.c2_plateau.sem, 4.5);
  EXPECT_EQ(summary.large_turns, 0.0) << "five of their spread";
}

// Angles that fluctuate about a director, variance s^2, without memory: C_2 = exp(-4 s^2) at once, MSAD = 2 s^2.
TEST(Rotation, OfRodsHeldByADirectorHasAPlateau) {
  Draw draw(103);
  std::vector<std::vector<double>> angles(2000, std::vector<double>(50));
  for (auto& sample : angles) {
    for (double& theta : sample) theta = 0.1 * draw.normal();
  }
  const RotationSummary summary = rotation_of(angles).summarize();
  EXPECT_LT(std::abs(summary.c2_plateau.value - std::exp(-0.04)) / summary.c2_plateau.sem, 4.5);
  EXPECT_LT(summary.c2_plateau.sem, 0.001);
  EXPECT_LT(std::abs(summary.d_r.value) / summary.d_r.sem, 4.5);
  EXPECT_TRUE(std::isnan(summary.c2_decay_time.value));
}

TEST(Rotation, CountsTurnsThatMayBeMisread) {
  const Rotation rotation = rotation_of({{0, 0, 0}, {1.0, 1.1, -1.1}, {2.0, 2.2, -1.2}});
  EXPECT_EQ(rotation.summarize().large_turns, 3.0);
  EXPECT_NEAR(rotation.reduce().msad.value[1], (4 + 2.2 * 2.2 + 1.2 * 1.2) / 3, 1e-12);
}

TEST(Rotation, UprightRodsKeepTheirAngle) {
  Rotation rotation(1.0);
  const Vec3 up(0, 0, 1), nan = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(rotation.reduce().lag.empty());
  rotation.accumulate(0, std::vector<Vec3>{up, axis(0.1)});
  rotation.accumulate(1, std::vector<Vec3>{up, up});
  EXPECT_EQ(rotation.reduce().msad.value.at(0), 0.0) << "of the second rod alone";
  rotation.accumulate(2, std::vector<Vec3>{axis(1), axis(0.3)});
  EXPECT_NEAR(rotation.reduce().msad.value.at(0), 0.04 / 2, 1e-14);
  EXPECT_NEAR(rotation.reduce().msad.value.at(1), 0.04, 1e-14);
  rotation.accumulate(3, std::vector<Vec3>{axis(1.3), nan});
  EXPECT_NEAR(rotation.reduce().msad.value.at(0), (0.04 + 0.09) / 3, 1e-14) << "the other one is missed";
  EXPECT_THROW(rotation.accumulate(4, std::vector<Vec3>{up}), std::logic_error);
  Rotation none(1.0);
  for (int i = 0; i < 4; ++i) none.accumulate(i, {});
  EXPECT_TRUE(none.reduce().lag.empty());
  EXPECT_TRUE(std::isnan(none.summarize().d_r.value));
}

}  // namespace
}  // namespace shaken::analysis
