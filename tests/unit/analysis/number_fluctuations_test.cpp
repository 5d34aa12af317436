#include "analysis/number_fluctuations.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace number_fluctuations_test {

constexpr double kBox = 60;

constexpr double kFitFrom = 6;  // a tenth of the box

Blocked<NumberFluctuations> counting(double fit_from = kFitFrom) {
  return Blocked(NumberFluctuations(kBox, kBox * kBox, fit_from));
}

// N rods at random, N given: a box of area fraction f holds a binomial number, std^2 = N f (1 - f), about its own mean
// as well. The variance's own relative error is sqrt(2 / (samples * boxes)) or less: below 5 % here, of std 2.5 %.
TEST(NumberFluctuations, OfIndependentRods) {
  Draw draw(91);
  auto blocks = counting();
  constexpr std::size_t kRods = 1200;
  for (int i = 0; i < 400; ++i) blocks.accumulate(i, random_places(draw, kRods, kBox));
  const NumberFluctuationCurve curve = NumberFluctuations::reduce(blocks, 0);
  ASSERT_EQ(curve.mean_n.size(), 10U);
  for (std::size_t k = 0; k < 10; ++k) {
    const double f = curve.area_fraction[k];
    const double want = std::sqrt(kRods * f * (1 - f));
    EXPECT_NEAR(curve.mean_n[k], kRods * f, 1e-9);
    EXPECT_NEAR(curve.std_n[k].value / want, 1, 0.06) << f;
    EXPECT_NEAR(curve.std_n_without_map[k].value / want, 1, 0.06) << f;
    // The error: that of the variance of independent boxes, known to 10 % from 58 stretches, and up to a half too large
    // where these seem to know of each other.
    const double boxes = 1 / f;
    const double sem = want / std::sqrt(2 * 400 * (boxes - 1));
    EXPECT_GT(curve.std_n[k].sem, 0.7 * sem) << f;
    EXPECT_LT(curve.std_n[k].sem, 1.6 * sem) << f;
  }
  EXPECT_DOUBLE_EQ(curve.area_fraction[0], 0.25);
  EXPECT_NEAR(curve.exponent.value, 0.5, 4 * curve.exponent.sem);
  EXPECT_LT(curve.exponent.sem, 0.01);
  EXPECT_NEAR(curve.exponent_without_map.value, 0.5, 4 * curve.exponent_without_map.sem);
  EXPECT_LT(curve.exponent_without_map.sem, 0.02);
}

// Two halves of the box with unlike densities, rods else independent: the difference grows as <N>, so the exponent of
// the raw numbers nears 1; without the map they are independent rods again.
TEST(NumberFluctuations, OfADensityMapThatStandsStill) {
  Draw draw(92);
  auto blocks = counting();
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec3> places = random_places(draw, 4000, kBox);
    for (std::size_t k = 0; k < places.size(); ++k) {
      places[k].x() = (k % 10 < 8 ? places[k].x() : places[k].x() + kBox) / 2;
    }
    blocks.accumulate(i, places);
  }
  const NumberFluctuationCurve curve = NumberFluctuations::reduce(blocks, 0);
  // Boxes of an even number of columns lie in one half: N = 1.6 or 0.4 times the mean.
  for (const std::size_t k : {0U, 2U}) EXPECT_NEAR(curve.std_n[k].value / curve.mean_n[k], 0.6, 0.01);
  EXPECT_GT(curve.exponent.value, 0.8);
  EXPECT_NEAR(curve.exponent_without_map.value, 0.5, 0.03);
  // A quarter holds each of the 3200 rods of its half with probability 1/2, or each of the 800 of the other half.
  EXPECT_NEAR(curve.std_n_without_map[0].value, std::sqrt((3200 * 0.25 + 800 * 0.25) / 2), 1.5);
}

// Two samples only: the spread about the mean of the two is half the variance, and is made up for. Over the 100 boxes
// of a hundredth its variance is good to 14 %.
TEST(NumberFluctuations, WithoutTheMapOfTwoSamples) {
  Draw draw(97);
  auto blocks = counting();
  for (int i = 0; i < 2; ++i) blocks.accumulate(i, random_places(draw, 4000, kBox));
  const NumberFluctuationCurve curve = NumberFluctuations::reduce(blocks, 0);
  EXPECT_NEAR(std::pow(curve.std_n_without_map[6].value, 2) / (40 * 0.99), 1, 0.4);
}

// Frozen clumps: large raw numbers, none without the map.
TEST(NumberFluctuations, OfFrozenClumps) {
  Draw draw(93);
  std::vector<Vec3> places;
  for (int clump = 0; clump < 30; ++clump) {
    const Vec3 centre{draw.uniform(0, kBox), draw.uniform(0, kBox), 0};
    for (int k = 0; k < 40; ++k) places.push_back(centre + Vec3{draw.normal(), draw.normal(), 0});
  }
  auto blocks = counting();
  for (int i = 0; i < 10; ++i) blocks.accumulate(i, places);
  const NumberFluctuationCurve curve = NumberFluctuations::reduce(blocks, 0);
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_GT(curve.std_n[k].value, 1.8 * std::sqrt(curve.mean_n[k] * (1 - curve.area_fraction[k]))) << k;
    EXPECT_EQ(curve.std_n_without_map[k].value, 0) << k;
  }
  EXPECT_TRUE(std::isnan(curve.exponent_without_map.value));
}

// Even within 2 mm, at random beyond: what counts is what boxes larger than that say. Cells of 2 mm, each with a number
// of rods of its own, four of them at its own places.
TEST(NumberFluctuations, AreFittedToBoxesLargerThanRods) {
  constexpr int kCells = 30;
  Draw draw(98);
  auto from_large = counting(10), from_small = counting(3), too_few = counting(15.1);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> places;
    for (int cell = 0; cell < kCells * kCells; ++cell) {
      if (draw.uniform(0, 1) < 0.5) continue;
      for (int k = 0; k < 20; ++k) {
        places.push_back(kBox / kCells *
                         Vec3{cell % kCells + draw.uniform(0, 1), cell / kCells + draw.uniform(0, 1), 0});
      }
    }
    for (auto* blocks : {&from_large, &from_small, &too_few}) blocks->accumulate(i, places);
  }
  const NumberFluctuationCurve large = NumberFluctuations::reduce(from_large, 0);
  const NumberFluctuationCurve small = NumberFluctuations::reduce(from_small, 0);
  const NumberFluctuationCurve none = NumberFluctuations::reduce(too_few, 0);
  EXPECT_EQ(large.fitted, 5U) << "30, 20, 15, 12, 10 mm";
  EXPECT_EQ(small.fitted, 10U);
  EXPECT_NEAR(large.exponent.value, 0.5, 0.05);
  EXPECT_GT(small.exponent.value, 0.53) << "boxes no larger than a cell see all of it or nothing";
  EXPECT_EQ(none.fitted, 2U);
  EXPECT_TRUE(std::isnan(none.exponent.value)) << "two sizes are no law";
  EXPECT_TRUE(std::isnan(none.exponent.sem));
  EXPECT_GT(none.std_n[0].value, 0) << "the numbers themselves are there";
}

TEST(NumberFluctuations, LeavesOutBoxesThatDoNotCountAndRodsThatAreNowhere) {
  const auto left_half = [](const Vec2& centre, const Vec2& sides) {
    return centre.x() + sides.x() / 2 <= kBox / 2 * (1 + 1e-9);
  };
  Blocked<NumberFluctuations> blocks(NumberFluctuations(kBox, kBox * kBox / 2, kFitFrom, left_half));
  Draw draw(95);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> places = random_places(draw, 1000, kBox);
    for (Vec3& place : places) place.x() = place.x() / 2 + 3 * kBox;  // in an image
    places[7].x() = std::numeric_limits<double>::quiet_NaN();
    blocks.accumulate(i, places);
  }
  const NumberFluctuationCurve curve = NumberFluctuations::reduce(blocks, 0);
  EXPECT_DOUBLE_EQ(curve.area_fraction[0], 0.5);
  EXPECT_NEAR(curve.mean_n[0], 999 / 2.0, 1e-9);
  EXPECT_NEAR(curve.mean_n[2], 999 / 8.0, 1e-9);
  EXPECT_NEAR(curve.std_n[2].value, std::sqrt(999 / 8.0 * 7 / 8), 0.6);
  EXPECT_NEAR(curve.exponent.value, 0.5, 0.05);
  Blocked<NumberFluctuations> none(
      NumberFluctuations(kBox, 1, kFitFrom, [](const Vec2&, const Vec2&) { return false; }));
  none.accumulate(0, random_places(draw, 10, kBox));
  EXPECT_TRUE(NumberFluctuations::reduce(none, 0).mean_n.empty());
}

TEST(NumberFluctuations, NothingOrOneRod) {
  auto blocks = counting();
  EXPECT_TRUE(std::isnan(NumberFluctuations::reduce(blocks, 0).mean_n[0]));
  blocks.accumulate(0, std::vector<Vec3>{});
  EXPECT_EQ(NumberFluctuations::reduce(blocks, 0).mean_n[0], 0);
  EXPECT_TRUE(std::isnan(NumberFluctuations::reduce(blocks, 0).exponent.value));
  blocks.accumulate(1, std::vector<Vec3>{Vec3(kBox, -1e-18, 0)});
  EXPECT_DOUBLE_EQ(NumberFluctuations::reduce(blocks, 0).mean_n[0], 0.125);
}

TEST(NumberFluctuations, BoxesAreAskedForByTheirMiddles) {
  Vec2 sum = Vec2::Zero();
  int n = 0;
  const NumberFluctuations boxes(8, 1, 1, [&](const Vec2& middle, const Vec2& sides) {
    EXPECT_TRUE(((middle - sides / 2).array() >= 0).all() && ((middle + sides / 2).array() <= 8).all());
    sum += middle;
    ++n;
    return true;
  });
  EXPECT_NEAR((sum / n - Vec2(4, 4)).norm(), 0, 1e-12);
}

}  // namespace number_fluctuations_test
}  // namespace shaken::analysis
