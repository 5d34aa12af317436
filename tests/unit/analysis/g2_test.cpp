#include "analysis/g2.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/lattices.h"

namespace shaken::analysis {
namespace {

// Rods on a line with theta = pi m x / L, which is periodic for an axis: G2 at distance r is cos(2 pi m r / L)
// exactly, also between rods joined through the boundary.
TEST(OrientationCorrelation, OfASplayWave) {
  constexpr double kBox = 50;
  constexpr int kRods = 100, kWaves = 2;
  std::vector<Vec3> positions, directors;
  for (int i = 0; i < kRods; ++i) {
    const double x = 0.1 + i * kBox / kRods;
    positions.push_back({x, 3, 0});
    directors.push_back(axis(kPi * kWaves * x / kBox));
  }
  // Bins a hair narrower than the spacing of the rods, so that distance k / 2 is safely in bin k.
  OrientationCorrelation g2(49, 24.5 * (1 - 1e-9));
  g2.accumulate(positions, directors, kBox);
  const OrientationCurve curve = g2.reduce();
  EXPECT_TRUE(std::isnan(curve.g2[0]));
  for (std::size_t k = 1; k < 49; ++k) {
    const double r = 0.5 * static_cast<double>(k);
    EXPECT_NEAR(curve.r[k], r + 0.25, 1e-6);
    EXPECT_NEAR(curve.g2[k], std::cos(2 * kPi * kWaves * r / kBox), 1e-10) << r;
  }
}

// The same wave in the plane: averaged over directions G2(r) = J0(2 pi m r / L). Random places leave an error of about
// 1 / sqrt(pairs in a bin) < 0.02 from the uneven directions; exp(i theta) in place of exp(2 i theta) gives J0 of half
// the argument, off by 0.4.
TEST(OrientationCorrelation, OfAWaveInThePlane) {
  constexpr double kBox = 50, kWaves = 2;
  Draw draw(61);
  OrientationCorrelation g2(25, 25);
  for (int k = 0; k < 10; ++k) {
    const std::vector<Vec3> positions = random_places(draw, 1000, kBox);
    std::vector<Vec3> directors;
    for (const Vec3& p : positions) directors.push_back(axis(kPi * kWaves * p.x() / kBox));
    g2.accumulate(positions, directors, kBox);
  }
  const OrientationCurve curve = g2.reduce();
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_NEAR(curve.g2[i], std::cyl_bessel_j(0, 2 * kPi * kWaves * curve.r[i] / kBox), 0.03) << curve.r[i];
  }
}

// Independent directions: the cosines of different pairs are uncorrelated with variance 1/2, each pair is met twice.
// Over 20 bins |z| < 4.5. Counting a rod with itself lifts the first bin by far more.
TEST(OrientationCorrelation, OfRandomRodsIsZeroAndOfAlignedOne) {
  constexpr double kBox = 40;
  Draw draw(62);
  OrientationCorrelation random(20, 20), aligned(20, 20);
  const std::vector<Vec3> positions = random_places(draw, 1000, kBox);
  random.accumulate(positions, random_axes(draw, 1000), kBox);
  aligned.accumulate(positions, std::vector<Vec3>(1000, axis(0.7, 0.1)), kBox);
  for (std::size_t i = 0; i < 20; ++i) {
    const double r = random.reduce().r[i];
    const double pairs = 0.5 * 1000 * 999 * 2 * kPi * r / (kBox * kBox);
    EXPECT_LT(std::abs(random.reduce().g2[i]) / std::sqrt(0.5 / pairs), 4.5);
    EXPECT_NEAR(aligned.reduce().g2[i], 1.0, 1e-12);
  }
}

// 2500 rods are taken as references in three sets; three calls on one state meet every pair once.
TEST(OrientationCorrelation, TakesEveryRodInItsTurn) {
  constexpr double kBox = 30;
  constexpr std::size_t kRods = 2500;
  Draw draw(63);
  const std::vector<Vec3> positions = random_places(draw, kRods, kBox);
  const std::vector<Vec3> directors = random_axes(draw, kRods);
  OrientationCorrelation g2(10, 10);
  for (int call = 0; call < 3; ++call) g2.accumulate(positions, directors, kBox);
  std::vector<double> sum(10), pairs(10);
  for (std::size_t i = 0; i < kRods; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double r = std::hypot(std::remainder(positions[i].x() - positions[j].x(), kBox),
                                  std::remainder(positions[i].y() - positions[j].y(), kBox));
      if (r >= 10) continue;
      const double between =
          std::atan2(directors[i].y(), directors[i].x()) - std::atan2(directors[j].y(), directors[j].x());
      sum[static_cast<std::size_t>(r)] += std::cos(2 * between);
      pairs[static_cast<std::size_t>(r)] += 1;
    }
  }
  for (std::size_t bin = 0; bin < 10; ++bin) EXPECT_NEAR(g2.reduce().g2[bin], sum[bin] / pairs[bin], 1e-9);
}

// However few the rods are: with n^2 pairs in place of n (n - 1), g of two rods would be a half, of seven 0.86.
TEST(OrientationCorrelation, PairDistributionOfAFewRodsIsOne) {
  for (const std::size_t n : {2U, 3U, 7U, 20U}) {
    constexpr double kBox = 20, kSamples = 40000;
    Draw draw(67);
    OrientationCorrelation g2(5, 10);
    for (int i = 0; i < kSamples; ++i) g2.accumulate(random_places(draw, n, kBox), random_axes(draw, n), kBox);
    const OrientationCurve curve = g2.reduce();
    const auto pairs = static_cast<double>(n * (n - 1) / 2);
    for (std::size_t i = 0; i < 5; ++i) {
      const double expected = kSamples * pairs * 2 * kPi * curve.r[i] * 2 / (kBox * kBox);
      EXPECT_LT(std::abs(curve.g[i] - 1) * std::sqrt(expected), 4.0) << n << " rods, " << curve.r[i] << " mm";
    }
  }
  OrientationCorrelation alone(5, 10);
  alone.accumulate(std::vector<Vec3>{{1, 1, 0}}, std::vector<Vec3>{axis(0)}, 20.0);
  for (const double g : alone.reduce().g) EXPECT_TRUE(std::isnan(g)) << "a single rod makes no pair";
  EXPECT_THROW(alone.accumulate({}, {}, 9.9), std::logic_error) << "half a box is shorter than the range";
}

/// Places at random in a region.
std::vector<Vec3> gas(Draw& draw, const Region& region, std::size_t n) {
  std::vector<Vec3> places;
  while (places.size() < n) {
    const Vec3 place{draw.uniform(0, region.box().x()), draw.uniform(0, region.box().x()), 0.5};
    if (region.contains(place.head<2>())) places.push_back(place);
  }
  return places;
}

// A gas in an arena is a gas: as much of each ring as lies within and in sight has its share of rods. Taken as
// periodic, of the mean density of the box, g of the disc would be 1.4 at first and fall to 0.9; with the rings cut by
// the walls but not by what they hide, the annulus' would fall short by a third at 20 mm. Pairs are counted from both
// ends, and rods near walls have fewer, so that the variance is a little more than twice the pairs: |z| < 4.5 over 60
// bins.
TEST(OrientationCorrelation, PairDistributionOfAGasInAnArenaIsOne) {
  constexpr double kBox = 42;
  constexpr std::size_t kRods = 800;
  Draw draw(66);
  for (const SideWalls& walls :
       {SideWalls{Arena::kDisc, 40}, SideWalls{Arena::kSquare, 40}, SideWalls{Arena::kAnnulus, 40, 20},
        SideWalls{.arena = Arena::kStadium, .size = 25, .length = 15}, SideWalls{Arena::kChannel, 30},
        SideWalls{.arena = Arena::kEllipse, .size = 20, .length = 40},
        SideWalls{.arena = Arena::kWedge, .size = 36, .length = 40}}) {
    const Region region(kBox, walls);
    OrientationCorrelation g2(20, 21);
    constexpr int kSamples = 20;
    for (int i = 0; i < kSamples; ++i) {
      g2.accumulate(gas(draw, region, kRods), random_axes(draw, kRods), region);
    }
    const OrientationCurve curve = g2.reduce();
    for (std::size_t i = 0; i < 20; ++i) {
      // At most the pairs of a gas whose rings lie inside.
      const double pairs = kSamples * kRods * kRods / region.area() * 2 * kPi * curve.r[i] * 21 / 20;
      EXPECT_NEAR(curve.g[i], 1.0, 4.5 * std::sqrt(4 / pairs) + 0.01) << walls.size << " " << curve.r[i];
    }
  }
}

// Rods at opposite walls are near to each other only through the border, and those on either side of an annulus' hole
// do not see each other.
TEST(OrientationCorrelation, HasNoPairsThroughWalls) {
  const std::vector<Vec3> opposite{{1.2, 21, 0}, {40.8, 21, 0}}, across_hole{{30.5, 21, 0}, {11.5, 21, 0}};
  const std::vector<Vec3> parallel(2, axis(0.3));
  const auto pairs_met = [&](const std::vector<Vec3>& places, const Region& region) {
    OrientationCorrelation g2(21, 21);
    g2.accumulate(places, parallel, region);
    const OrientationCurve curve = g2.reduce();
    return std::count_if(curve.g2.begin(), curve.g2.end(), [](double value) { return !std::isnan(value); });
  };
  EXPECT_EQ(pairs_met(opposite, 42.0), 1) << "2.4 mm apart";
  EXPECT_EQ(pairs_met(opposite, Region(42, SideWalls{Arena::kDisc, 40})), 0);
  EXPECT_EQ(pairs_met(opposite, Region(42, SideWalls{Arena::kSquare, 40})), 0);
  EXPECT_EQ(pairs_met(opposite, Region(42, SideWalls{Arena::kChannel, 40})), 1) << "across its border";
  EXPECT_EQ(pairs_met({{21, 1.2, 0}, {21, 40.8, 0}}, Region(42, SideWalls{Arena::kChannel, 40})), 0);
  EXPECT_EQ(pairs_met(across_hole, Region(42, SideWalls{Arena::kDisc, 40})), 1) << "19 mm apart";
  EXPECT_EQ(pairs_met(across_hole, Region(42, SideWalls{Arena::kAnnulus, 40, 10})), 0);
  const std::vector<Vec3> beside_hole{{30.5, 27, 0}, {11.5, 27, 0}};
  EXPECT_EQ(pairs_met(beside_hole, Region(42, SideWalls{Arena::kAnnulus, 40, 10})), 1);
}

}  // namespace
}  // namespace shaken::analysis
