#include "analysis/pair_map.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/lattices.h"

namespace shaken::analysis {
namespace {

// A gas with its director askew: every bin within half the box holds refs x (n - 1) x its share of the box, each pair
// twice; over the map |z| < 5 and chi^2 as it should be. Bins beyond half the box would be short: they are NaN.
TEST(PairMap, OfAGasIsOneAndOfRandomRodsZero) {
  constexpr double kBox = 20, kRods = 1000, kSamples = 20;
  constexpr int kBins = 21;
  Draw draw(151);
  PairMap map({kBins, kBox / 2, 1.0, kBox}), aligned({kBins, kBox / 2, 1.0, kBox});
  for (int i = 0; i < kSamples; ++i) {
    const std::vector<Vec3> places = random_places(draw, static_cast<std::size_t>(kRods), kBox);
    map.accumulate(places, random_axes(draw, static_cast<std::size_t>(kRods)));
    aligned.accumulate(places, std::vector<Vec3>(static_cast<std::size_t>(kRods), axis(0.4)));
  }
  const PairCurves curves = map.reduce();
  const double width = kBox / kBins;
  const double expected = kSamples * kRods * (kRods - 1) * width * width / (kBox * kBox);
  const double sigma = std::sqrt(1 / expected);  // of pairs counted from both ends, in two bins that are averaged
  double chi2 = 0, n = 0;
  for (std::size_t i = 0; i < curves.g.size(); ++i) {
    const double x = std::abs(curves.along[i % kBins]) + width / 2, y = std::abs(curves.across[i / kBins]) + width / 2;
    if (x * x + y * y > kBox * kBox / 4) {
      EXPECT_TRUE(std::isnan(curves.g[i]) && std::isnan(curves.g2[i]));
      continue;
    }
    const double z = (curves.g[i] - 1) / sigma;
    EXPECT_LT(std::abs(z), 5.0) << i;
    EXPECT_EQ(curves.g[i], curves.g[curves.g.size() - 1 - i]);
    EXPECT_LT(std::abs(curves.g2[i]), 5.0 * std::sqrt(0.5) * sigma) << i;
    EXPECT_NEAR(aligned.reduce().g2[i], 1.0, 1e-12);
    chi2 += z * z;
    n += 1;
  }
  EXPECT_GT(n, 200);
  EXPECT_LT(std::abs(chi2 - n) / std::sqrt(4 * n), 4.0);  // the bins come in equal pairs

  ASSERT_EQ(curves.r.size(), 10u);
  EXPECT_NEAR(curves.r[3], 3.5 * width, 1e-12);
  const double cut_sigma = std::sqrt(2 / (kSamples * kRods * (kRods - 1) * 2 * width * 1.0 / (kBox * kBox)));
  for (std::size_t i = 0; i < curves.r.size(); ++i) {
    EXPECT_LT(std::abs(curves.g_along[i] - 1) / cut_sigma, 4.5);
    EXPECT_LT(std::abs(curves.g_across[i] - 1) / cut_sigma, 4.5);
    EXPECT_LT(std::abs(curves.g2_along[i]) / cut_sigma, 4.5);
    EXPECT_LT(std::abs(curves.g2_across[i]) / cut_sigma, 4.5);
  }
}

// However few the rods are.
TEST(PairMap, OfThreeRodsIsOne) {
  constexpr double kBox = 20, kSamples = 100000;
  constexpr int kBins = 5;
  Draw draw(152);
  PairMap map({kBins, 6.0, 4.0, kBox});
  for (int i = 0; i < kSamples; ++i) map.accumulate(random_places(draw, 3, kBox), random_axes(draw, 3));
  const double width = 12.0 / kBins;
  const double sigma = std::sqrt(1 / (kSamples * 3 * 2 * width * width / (kBox * kBox)));
  for (const double g : map.reduce().g) EXPECT_LT(std::abs(g - 1) / sigma, 4.5 * std::sqrt(2.0));
}

// theta oscillates along the normal of a director along 0.5: G2(x, y) = <cos 2 (theta_i - theta_j)> depends on y alone.
// With theta = director + a sin(k y), k times the normal a wave vector of the box, cos 2 a (sin u - sin v) averages
// over the mean place to J0(4 a sin(k y / 2)).
TEST(PairMap, KnowsAlongFromAcross) {
  constexpr double kBox = 30, kTilt = 0.3;
  const double director = std::atan2(3.0, 4.0);  // normal (-3, 4) / 5
  const Vec2 wave = 2 * kPi / kBox * Vec2(-3, 4);
  Draw draw(152);
  PairMap map({31, 6.0, 0.5, kBox});
  for (int i = 0; i < 20; ++i) {
    const std::vector<Vec3> places = random_places(draw, 1000, kBox);
    std::vector<Vec3> rods;
    for (const Vec3& place : places) rods.push_back(axis(director + kTilt * std::sin(wave.dot(place.head<2>()))));
    map.accumulate(places, rods);
  }
  const PairCurves curves = map.reduce();
  const auto expected = [&](double y) {
    return std::cyl_bessel_j(0, 4 * kTilt * std::abs(std::sin(wave.norm() * y / 2)));
  };
  double sum = 0;
  for (std::size_t row = 0; row < 31; ++row) {
    for (std::size_t column = 0; column < 31; ++column) {
      const double error = curves.g2[row * 31 + column] - expected(curves.across[row]);
      EXPECT_NEAR(error, 0.0, 0.12);
      sum += std::abs(error) / (31 * 31);
    }
  }
  EXPECT_LT(sum, 0.03);
  for (std::size_t i = 0; i < curves.r.size(); ++i) {
    EXPECT_NEAR(curves.g2_across[i], expected(curves.r[i]), 0.06) << curves.r[i];
    EXPECT_GT(curves.g2_along[i], 0.96) << curves.r[i];
  }
}

TEST(PairMap, OddInput) {
  constexpr double kBox = 20;
  const PairMap::Shape shape{9, 4.0, 0.8, kBox};
  EXPECT_THROW(PairMap({9, 10.1, 0.8, kBox}), std::logic_error);

  PairMap odd(shape);
  odd.accumulate({}, {});
  EXPECT_TRUE(std::isnan(odd.reduce().g[0]));
  odd.accumulate(std::vector<Vec3>{{1, 1, 0}}, std::vector<Vec3>{axis(1)});
  EXPECT_TRUE(std::isnan(odd.reduce().g[0])) << "a single rod makes no pair";
  EXPECT_TRUE(std::isnan(odd.reduce().g2[0]));
  odd = PairMap(shape);
  odd.accumulate(std::vector<Vec3>{{1, 1, 0}, {2, 1, 0}}, std::vector<Vec3>{axis(1), {0, 0, 1}});
  for (const double g : odd.reduce().g) EXPECT_TRUE(std::isnan(g)) << "the rod upright is none";
}

}  // namespace
}  // namespace shaken::analysis
