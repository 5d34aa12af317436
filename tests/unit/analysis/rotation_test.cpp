#include "analysis/rotation.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/walks.h"

namespace shaken::analysis {
namespace {

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
  const auto angles = turning(draw, 5, 300, 0.2);
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
  EXPECT_NEAR(rotation.reduce().msad.value.at(0), (0.04 + 0.09) / 4, 1e-14);
  EXPECT_THROW(rotation.accumulate(4, std::vector<Vec3>{up}), std::logic_error);
  Rotation none(1.0);
  for (int i = 0; i < 4; ++i) none.accumulate(i, {});
  EXPECT_TRUE(none.reduce().lag.empty());
  EXPECT_TRUE(std::isnan(none.summarize().d_r.value));
}

}  // namespace
}  // namespace shaken::analysis
