#include "analysis/van_hove.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/unit/analysis/walks.h"

namespace shaken::analysis {
namespace {

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

VanHove van_hove_of(const Frames& frames, double director, double longest, int bins, double range) {
  VanHove van_hove(1.0, longest, bins, range);
  for (std::size_t i = 0; i < frames.size(); ++i) van_hove.accumulate(static_cast<double>(i), frames[i], director);
  return van_hove;
}

// Walks whose steps have the spread s: at t steps a Gaussian of spread s sqrt(t), and in the plane a Rayleigh
// distribution.
TEST(VanHove, OfDiffusionIsGaussian) {
  constexpr double kTheta = 0.7, kAcross = 0.5;
  Draw draw(321);
  const Frames frames = walks(draw, 400, 641, kTheta, 1.0, kAcross);
  const VanHove van_hove = van_hove_of(frames, kTheta, 64, 20, 30);
  ASSERT_EQ(van_hove.n_lags(), 4u);
  const auto below = [](double x, double spread) { return 0.5 * std::erf(x / spread / std::sqrt(2.0)); };
  for (std::size_t k = 0; k < 4; ++k) {
    const double steps = std::pow(4.0, k), range = 30 * std::exp2(k) / 8, width = range / 20;
    EXPECT_EQ(van_hove.lag(k), steps);
    const DisplacementCurve curve = van_hove.displacements(k).all().reduce();
    const double rods = 400 * std::floor(640 / steps);
    for (std::size_t bin = 0; bin < 20; ++bin) {
      const double from = static_cast<double>(bin) * width, to = from + width;
      EXPECT_NEAR(curve.displacement[bin], from + width / 2, 1e-12);
      const auto expect = [&](const std::vector<double>& density, double share, double weight) {
        const double count = rods * share;  // by chance its root
        EXPECT_NEAR(density[bin] * rods * width * weight, count, 4.5 * std::sqrt(count) + 1) << steps << " " << bin;
      };
      const double s = std::sqrt(steps);
      expect(curve.along, 2 * (below(to, s) - below(from, s)), 2);
      expect(curve.across, 2 * (below(to, kAcross * s) - below(from, kAcross * s)), 2);
    }
  }
}

TEST(VanHove, DistancesOfIsotropicDiffusionAreRayleighs) {
  Draw draw(322);
  const VanHove van_hove = van_hove_of(walks(draw, 2000, 65, 0, 1.0, 1.0), 0.4, 64, 10, 24);
  const DisplacementCurve curve = van_hove.displacements(3).all().reduce();  // of 64 steps: a spread of 8
  for (std::size_t bin = 0; bin < 10; ++bin) {
    const auto beyond = [](double r) { return std::exp(-r * r / 2 / 64); };
    const double from = static_cast<double>(bin) * 2.4, share = beyond(from) - beyond(from + 2.4);
    EXPECT_NEAR(curve.distance[bin] * 2.4, share, 4.5 * std::sqrt(share / 2000));
  }
  EXPECT_NEAR(curve.beyond, std::exp(-4.5), 4.5 * std::sqrt(std::exp(-4.5) / 2000));
}

// The slow twin keeps all frames; the director turns with time, and origins follow each other by one lag.
TEST(VanHove, EqualsTheCountOverAllFrames) {
  constexpr int kBins = 7;
  Draw draw(323);
  const Frames frames = walks(draw, 6, 101, 0, 1.0, 0.4);
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

}  // namespace
}  // namespace shaken::analysis
