// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/accuracy/bias.h"

namespace shaken::bench {
namespace {

TEST(Limit, IsExactOnALine) {
  const std::vector<double> x{1, 2, 4, 8};
  const std::vector<Mean> means{{3.5, 0.1}, {4, 0.2}, {5, 0.1}, {7, 0.3}};
  const Limit limit = limit_of(x, means);
  EXPECT_NEAR(limit.at_zero.value, 3, 1e-12);
  EXPECT_NEAR(limit.slope.value, 0.5, 1e-12);
  EXPECT_NEAR(limit.chi_squared, 0, 1e-20);
  EXPECT_EQ(limit.freedom, 2);
}

TEST(Limit, ErrorsAreThoseOfTwoPoints) {
  // from y(1) +- 0.3 and y(3) +- 0.1: slope (y3 - y1) / 2, at zero (3 y1 - y3) / 2
  const Limit limit = limit_of(std::vector<double>{1, 3}, std::vector<Mean>{{10, 0.3}, {20, 0.1}});
  EXPECT_NEAR(limit.slope.sem, std::hypot(0.3, 0.1) / 2, 1e-12);
  EXPECT_NEAR(limit.at_zero.value, 5, 1e-12);
  EXPECT_NEAR(limit.at_zero.sem, std::hypot(0.9, 0.1) / 2, 1e-12);
}

TEST(Limit, WeighsByErrors) {
  const Limit limit = limit_of(std::vector<double>{1, 2, 3}, std::vector<Mean>{{1, 1e-3}, {2, 1e-3}, {9, 1e3}});
  EXPECT_NEAR(limit.slope.value, 1, 1e-6);
  // the middle one is off by 1 error of an even line
  EXPECT_NEAR(limit_of(std::vector<double>{0, 1, 2}, std::vector<Mean>{{0, 1}, {3, 1}, {0, 1}}).chi_squared, 6, 1e-12);
}

TEST(Bias, IsRelativeToTheTruth) {
  const Mean bias = relative_bias({1.1, 0.03}, {1.0, 0.04});
  EXPECT_NEAR(bias.value, 0.1, 1e-12);
  EXPECT_NEAR(bias.sem, std::hypot(0.03, 1.1 * 0.04), 1e-12);
}

TEST(Bias, IsJudgedWithTwoErrorsToSpare) {
  EXPECT_EQ(judge({0.004, 0.002}, 0.01), Verdict::kBelow);
  EXPECT_EQ(judge({-0.004, 0.002}, 0.01), Verdict::kBelow);
  EXPECT_EQ(judge({-0.03, 0.002}, 0.01), Verdict::kAbove);
  EXPECT_EQ(judge({0.0, 0.006}, 0.01), Verdict::kOpen);
  EXPECT_EQ(judge({0.02, 0.006}, 0.01), Verdict::kOpen);
}

TEST(Bias, TheLastStepBelowHasAllFinerOnesBelow) {
  const Mean good{0, 0.001}, open{0, 0.02};
  EXPECT_EQ(last_below(std::vector{good, good, open, good}, 0.01), 1u);
  EXPECT_EQ(last_below(std::vector{good, good}, 0.01), 1u);
  EXPECT_FALSE(last_below(std::vector{open, good}, 0.01));
}

}  // namespace
}  // namespace shaken::bench
