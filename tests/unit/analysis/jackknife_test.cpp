// SPDX-License-Identifier: MIT
#include "analysis/jackknife.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/samples.h"

namespace shaken::analysis {
namespace {

struct Sums {
  double n = 0, x = 0, y = 0;
  void merge(const Sums& other) {
    n += other.n;
    x += other.x;
    y += other.y;
  }
};

// Of a mean it is the textbook standard error, exactly; of a ratio of means its spread over repetitions.
TEST(Jackknife, OfAMeanAndOfARatio) {
  Draw draw(101);
  double spread = 0, error = 0;
  constexpr int kRepetitions = 400;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<Sums> blocks;
    std::vector<double> x;
    for (int b = 0; b < 16; ++b) {
      x.push_back(4 + draw.normal());
      blocks.push_back({1, x.back(), 10 + draw.normal()});
    }
    const std::vector<Estimate> e = jackknife(Sums{}, blocks, [](const Sums& s) {
      return std::vector<double>{s.x / s.n, s.x / s.y};
    });
    double squares = 0;
    for (const double value : x) squares += std::pow(value - e[0].value, 2);
    EXPECT_NEAR(e[0].sem, std::sqrt(squares / (16 * 15)), 1e-12);
    spread += std::pow(e[1].value - 0.4, 2) / kRepetitions;
    error += std::pow(e[1].sem, 2) / kRepetitions;
  }
  // sigma^2 = (1 + 0.4^2) / (10^2 * 16); the mean of 400 squares is good to 7 %.
  EXPECT_NEAR(spread / (1.16 / 1600), 1, 0.3);
  EXPECT_NEAR(error / (1.16 / 1600), 1, 0.15);
}

TEST(Jackknife, SaysSoWhereTheErrorIsUnknown) {
  const auto inverse = [](const Sums& s) { return std::vector<double>{1 / s.x}; };
  EXPECT_DOUBLE_EQ(jackknife(Sums{}, {Sums{1, 2, 0}}, inverse)[0].value, 0.5);
  EXPECT_TRUE(std::isnan(jackknife(Sums{}, {Sums{1, 2, 0}}, inverse)[0].sem));
  EXPECT_TRUE(std::isnan(jackknife(Sums{}, {Sums{1, 2, 0}, Sums{1, 0, 0}}, inverse)[0].sem));
}

}  // namespace
}  // namespace shaken::analysis
