// SPDX-License-Identifier: MIT
#include "scene/points.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace shaken::scene {
namespace {

using testing::ElementsAre;

constexpr const char* kPaths[] = {"rods.length", "box.gap", "plates.gamma"};

/// Coordinates [dimension][point] of points in as many dimensions as there are paths.
std::vector<std::vector<double>> cloud(Spread spread, int n, std::uint64_t seed) {
  std::vector<std::vector<double>> all;
  for (int d = 0; d < 3; ++d) all.push_back(CubePoints{spread, n, seed}.coordinates(kPaths[d], d));
  return all;
}

/// How many of the coordinates lie in each of `n` equal parts of [0, 1).
std::vector<int> counts(const std::vector<double>& coordinates, int n) {
  std::vector<int> found(static_cast<std::size_t>(n));
  for (const double x : coordinates) ++found.at(static_cast<std::size_t>(x * n));
  return found;
}

/// Star discrepancy in two dimensions, from its definition: the largest difference between the share of points in a
/// box [0, a) x [0, b), or in the closed one, and its area. It is taken at coordinates of points, or at 1.
double star_discrepancy(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> corners_x = x, corners_y = y;
  corners_x.push_back(1);
  corners_y.push_back(1);
  double worst = 0;
  for (const double a : corners_x) {
    for (const double b : corners_y) {
      double open = 0, closed = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        open += x[i] < a && y[i] < b ? 1 : 0;
        closed += x[i] <= a && y[i] <= b ? 1 : 0;
      }
      const double n = static_cast<double>(x.size());
      worst = std::max({worst, a * b - open / n, closed / n - a * b});
    }
  }
  return worst;
}

/// Whether the first digits of the first d direction numbers in d dimensions are a regular matrix, modulo 2.
bool is_regular(int d) {
  std::vector<std::uint32_t> rows;
  for (int dimension = 0; dimension < d; ++dimension) {
    const SobolSequence sequence(dimension);
    std::uint32_t row = 0;
    for (int k = 0; k < d; ++k) {
      // In the order of Gray's code, point 2^k differs from the one before it by direction number k.
      const std::uint32_t at = std::uint32_t{1} << k;
      row |= ((sequence.point(at) ^ sequence.point(at - 1)) >> 31) << k;
    }
    rows.push_back(row);
  }
  for (int column = 0; column < d; ++column) {
    const auto from = rows.begin() + column;
    const auto pivot = std::find_if(from, rows.end(), [&](std::uint32_t row) { return ((row >> column) & 1) != 0; });
    if (pivot == rows.end()) return false;
    std::iter_swap(from, pivot);
    for (auto row = from + 1; row != rows.end(); ++row) {
      if (((*row >> column) & 1) != 0) *row ^= *from;
    }
  }
  return true;
}

// The first points in three dimensions, as Joe & Kuo print them beside their program.
TEST(Points, SobolsFirstPointsAreThosePublished) {
  const double published[10][3] = {{0, 0, 0},
                                   {0.5, 0.5, 0.5},
                                   {0.75, 0.25, 0.25},
                                   {0.25, 0.75, 0.75},
                                   {0.375, 0.375, 0.625},
                                   {0.875, 0.875, 0.125},
                                   {0.625, 0.125, 0.875},
                                   {0.125, 0.625, 0.375},
                                   {0.1875, 0.3125, 0.9375},
                                   {0.6875, 0.8125, 0.4375}};
  for (int d = 0; d < 3; ++d) {
    const SobolSequence sequence(d);
    for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(sequence.point(i) * 0x1p-32, published[i][d]) << i << " " << d;
  }
}

// Point 1000 in all dimensions, in units of 2^-10, from the authors' list by their algorithm written again elsewhere.
TEST(Points, AllDimensionsOfSobolsSequenceAreThoseOfTheList) {
  constexpr std::uint32_t kPoint[] = {225, 99,  531,  693, 287, 929, 47,  921, 513, 71,  87, 261,  165, 393, 147, 379,
                                      737, 353, 1015, 743, 535, 563, 973, 553, 597, 929, 41, 1003, 61,  349, 151, 149};
  static_assert(std::size(kPoint) == kMaxSobolDimensions);
  for (int d = 0; d < kMaxSobolDimensions; ++d) EXPECT_EQ(SobolSequence(d).point(1000), kPoint[d] << 22) << d;
}

// Sobol's property A, which the direction numbers were chosen for: of the first 2^d points, one lies in each of the 2^d
// equal boxes that halving every dimension makes.
TEST(Points, SobolsSequenceHasPropertyAInAllItsDimensions) {
  for (int d = 1; d <= kMaxSobolDimensions; ++d) EXPECT_TRUE(is_regular(d)) << d;
}

TEST(Points, AnyPowerOfTwoOfSobolPointsIsEvenInEveryDimension) {
  for (int d = 0; d < kMaxSobolDimensions; ++d) {
    for (const int n : {2, 64, 1024}) {
      const auto x = CubePoints{Spread::kSobol, n, 3}.coordinates("rods.length", d);
      EXPECT_EQ(counts(x, n), std::vector<int>(static_cast<std::size_t>(n), 1)) << n << " points, dimension " << d;
    }
  }
}

// The first two dimensions are a net: each box of area 1/n with sides that are powers of 1/2 holds one of n points.
TEST(Points, SobolPointsInAPlaneAreANetWhateverTheSeed) {
  EXPECT_TRUE(rc::check("one point in each elementary box", [] {
    const int log_n = *rc::gen::inRange(0, 10), log_columns = *rc::gen::inRange(0, log_n + 1);
    const auto x = cloud(Spread::kSobol, 1 << log_n, *rc::gen::arbitrary<std::uint32_t>());
    std::set<std::pair<int, int>> boxes;
    for (std::size_t i = 0; i < x[0].size(); ++i) {
      boxes.emplace(static_cast<int>(x[0][i] * (1 << log_columns)),
                    static_cast<int>(x[1][i] * (1 << (log_n - log_columns))));
    }
    RC_ASSERT(boxes.size() == x[0].size());
  }));
}

TEST(Points, ALatinHypercubeHasOnePointInEachStratum) {
  EXPECT_TRUE(rc::check("in each dimension", [] {
    const int n = *rc::gen::inRange(1, 2000);
    for (const auto& x : cloud(Spread::kLatin, n, *rc::gen::arbitrary<std::uint32_t>())) {
      RC_ASSERT(counts(x, n) == std::vector<int>(static_cast<std::size_t>(n), 1));
    }
  }));
}

// Strata alone would also be hit by points in order, or in the same order in every dimension.
TEST(Points, StrataOfALatinHypercubeArePairedAtRandom) {
  constexpr int kN = 2000;
  const auto x = cloud(Spread::kLatin, kN, 5);
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - 0.5) * (b[i] - 0.5);
    return 12 * sum / static_cast<double>(a.size());
  };
  std::vector<double> order(kN);
  for (int i = 0; i < kN; ++i) order[static_cast<std::size_t>(i)] = (i + 0.5) / kN;
  const double four_errors = 4 / std::sqrt(kN);
  EXPECT_LT(std::abs(correlation(x[0], x[1])), four_errors);
  EXPECT_LT(std::abs(correlation(x[1], x[2])), four_errors);
  EXPECT_LT(std::abs(correlation(x[0], order)), four_errors);
  // Every permutation of three is equally likely: 6 of them, 3000 seeds.
  std::vector<int> seen(6);
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto three = CubePoints{Spread::kLatin, 3, seed}.coordinates("box.gap", 0);
    const int first = static_cast<int>(three[0] * 3), second = static_cast<int>(three[1] * 3);
    ++seen.at(static_cast<std::size_t>(2 * first + (second > first ? second - 1 : second)));
  }
  for (const int n : seen) EXPECT_NEAR(n, 500, 4 * std::sqrt(3000.0 * 5 / 36));
}

TEST(Points, MorePointsKeepTheFirstOnesIfRandomOrSobol) {
  EXPECT_TRUE(rc::check("a prefix", [] {
    const int n = *rc::gen::inRange(1, 300), more = n + *rc::gen::inRange(0, 300);
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    for (const Spread spread : {Spread::kRandom, Spread::kSobol}) {
      const auto few = cloud(spread, n, seed), many = cloud(spread, more, seed);
      for (std::size_t d = 0; d < 3; ++d) RC_ASSERT(std::equal(few[d].begin(), few[d].end(), many[d].begin()));
    }
  }));
}

TEST(Points, SobolPointsAndLatinOnesLieMoreEvenlyThanRandomOnes) {
  double random = 0, latin = 0, most_of_sobol = 0, least_of_random = 1;
  constexpr int kSeeds = 20;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto discrepancy = [&](Spread spread) {
      const auto x = cloud(spread, 128, seed);
      return star_discrepancy(x[0], x[1]);
    };
    const double of_random = discrepancy(Spread::kRandom);
    random += of_random / kSeeds;
    latin += discrepancy(Spread::kLatin) / kSeeds;
    least_of_random = std::min(least_of_random, of_random);
    most_of_sobol = std::max(most_of_sobol, discrepancy(Spread::kSobol));
  }
  EXPECT_LT(most_of_sobol, least_of_random);
  EXPECT_LT(latin, random);
  RecordProperty("sobol_at_most", std::to_string(most_of_sobol));
  RecordProperty("random_mean", std::to_string(random));
}

TEST(Points, SeedsAndPathsHaveNothingInCommon) {
  for (const Spread spread : {Spread::kRandom, Spread::kLatin, Spread::kSobol}) {
    const auto of = [&](std::uint64_t seed, const char* path) {
      return CubePoints{spread, 50, seed}.coordinates(path, 0);
    };
    EXPECT_EQ(of(1, "box.gap"), of(1, "box.gap"));
    EXPECT_NE(of(1, "box.gap"), of(2, "box.gap"));
    EXPECT_NE(of(1, "box.gap"), of(1, "box.side"));
  }
}

// Held to the last bit: every machine and compiler draws the same points, so that a sweep has the same runs.
TEST(Points, TheBitsAreTheSameEverywhere) {
  EXPECT_THAT((CubePoints{Spread::kRandom, 3, 1}.coordinates("box.gap", 0)),
              ElementsAre(0x1.c157ec858a68p-3, 0x1.137cf688f64eep-2, 0x1.cdb5863c2fb8p-8));
  EXPECT_THAT((CubePoints{Spread::kLatin, 3, 1}.coordinates("box.gap", 0)),
              ElementsAre(0x1.87ef7d18aaaabp-1, 0x1.093f8deeaaaabp-2, 0x1.4d74ba96aaaabp-1));
  EXPECT_THAT((CubePoints{Spread::kSobol, 3, 1}.coordinates("box.gap", 7)),
              ElementsAre(0x1.714a2c14ac27p-4, 0x1.701bbfe63cc1fp-1, 0x1.c9bdfe393f7c4p-1));
  EXPECT_EQ(between_on_log_scale(0.3, 70, 0.37), 0x1.20b94d21d30f9p+1);
}

TEST(Points, TheLogarithmicScaleIsExactToRounding) {
  EXPECT_TRUE(rc::check("as libm has it", [] {
    const double from = std::pow(10.0, *rc::gen::inRange(-700, 700) / 100.0),
                 ratio = 1 + *rc::gen::inRange(0, 100'000'000) / 10.0;
    const double share = *rc::gen::inRange(0, 1000) / 1000.0;
    const double expected = from * std::pow(ratio, share);
    RC_ASSERT(std::abs(between_on_log_scale(from, from * ratio, share) - expected) < 1e-14 * expected);
  }));
}

}  // namespace
}  // namespace shaken::scene
