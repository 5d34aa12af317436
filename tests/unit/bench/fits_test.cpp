// SPDX-License-Identifier: MIT
#include "bench/fits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/accuracy/accuracy.h"

namespace shaken::bench {
namespace {

TEST(Limit, IsExactOnALine) {
  const std::vector<double> x{1, 2, 4, 8};
  const std::vector<Estimate> means{{3.5, 0.1}, {4, 0.2}, {5, 0.1}, {7, 0.3}};
  const Limit limit = limit_of(x, means);
  EXPECT_NEAR(limit.at_zero.value, 3, 1e-12);
  EXPECT_NEAR(limit.slope.value, 0.5, 1e-12);
  EXPECT_NEAR(limit.chi_squared, 0, 1e-20);
  EXPECT_EQ(limit.freedom, 2);
}

TEST(Limit, ErrorsAreThoseOfTwoPoints) {
  // from y(1) +- 0.3 and y(3) +- 0.1: slope (y3 - y1) / 2, at zero (3 y1 - y3) / 2
  const Limit limit = limit_of(std::vector<double>{1, 3}, std::vector<Estimate>{{10, 0.3}, {20, 0.1}});
  EXPECT_NEAR(limit.slope.sem, std::hypot(0.3, 0.1) / 2, 1e-12);
  EXPECT_NEAR(limit.at_zero.value, 5, 1e-12);
  EXPECT_NEAR(limit.at_zero.sem, std::hypot(0.9, 0.1) / 2, 1e-12);
}

TEST(Limit, WeighsByErrors) {
  const Limit limit = limit_of(std::vector<double>{1, 2, 3}, std::vector<Estimate>{{1, 1e-3}, {2, 1e-3}, {9, 1e3}});
  EXPECT_NEAR(limit.slope.value, 1, 1e-6);
  // the middle one is off by 1 error of an even line
  EXPECT_NEAR(limit_of(std::vector<double>{0, 1, 2}, std::vector<Estimate>{{0, 1}, {3, 1}, {0, 1}}).chi_squared, 6,
              1e-12);
}

TEST(Bias, IsRelativeToTheTruth) {
  const Estimate bias = relative_bias({1.1, 0.03}, {1.0, 0.04});
  EXPECT_NEAR(bias.value, 0.1, 1e-12);
  EXPECT_NEAR(bias.sem, std::hypot(0.03, 1.1 * 0.04), 1e-12);
}

TEST(Bias, IsJudgedWithTwoErrorsToSpare) {
  EXPECT_STREQ(verdict({0.004, 0.002}, 0.01), "below");
  EXPECT_STREQ(verdict({-0.004, 0.002}, 0.01), "below");
  EXPECT_STREQ(verdict({-0.03, 0.002}, 0.01), "above");
  EXPECT_STREQ(verdict({0.0, 0.006}, 0.01), "open");
  EXPECT_STREQ(verdict({0.02, 0.006}, 0.01), "open");
}

/// What the report tells of the steps 1, 2, 4, ... us whose biases of S have these verdicts.
std::string steps_below(const std::vector<const char*>& verdicts) {
  StatisticsTask task{.scene = make_case(4.5, 0.75, 12, kPaperStep, 1), .values = {1}};
  Json rows = Json::array();
  for (const char* verdict : verdicts) {
    rows.push_back({{"value", std::exp2(rows.size())}, {"S", {{"bias", 0}, {"verdict", verdict}}}});
  }
  const Json limits = Json::parse(R"([{"observable": "S", "chi_squared": 1, "freedom": 0}])");
  const std::string text =
      statistics_report({task}, {{{"rows", rows}, {"limits", limits}, {"tilt", Json::array()}}}).text;
  return text.substr(text.find("  S: ") + 5);
}

TEST(Bias, TheLastStepBelowHasAllFinerOnesBelow) {
  EXPECT_EQ(steps_below({"below", "below", "open", "below"}), "2 us (4 us: open)\n");
  EXPECT_EQ(steps_below({"below", "below"}), "2 us\n");
  EXPECT_EQ(steps_below({"above", "below"}), "none (1 us: above)\n");
}

const std::vector<double> kSteps{1, 2, 4, 8, 16, 32};

std::vector<double> errors_of(auto error) {
  std::vector<double> errors;
  for (const double dt : kSteps) errors.push_back(error(dt));
  return errors;
}

TEST(OrderFit, IsExactForAPower) {
  for (const double order : {1.0, 2.0, 0.5}) {
    const auto fit = fit_order(kSteps, errors_of([&](double dt) { return 3 * std::pow(dt, order); }), 0);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->order, order, 1e-12);
    EXPECT_NEAR(fit->coefficient, 3, 1e-11);
    EXPECT_LT(fit->order_error, 1e-7);
    EXPECT_EQ(fit->points, 6);
  }
}

TEST(OrderFit, ItsErrorIsTheSlopesStandardError) {
  // y = x +- 0.1 log 2, alternating, at x = 0 .. 3 log 2: slope 0.96, squares about the line 0.032, over two degrees of
  // freedom and the squares of x, 5
  const auto fit = fit_order(std::vector<double>{1, 2, 4, 8},
                             std::vector<double>{std::exp2(0.1), std::exp2(0.9), std::exp2(2.1), std::exp2(2.9)}, 0);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 0.96, 1e-12);
  EXPECT_NEAR(fit->order_error, std::sqrt(0.032 / 2 / 5), 1e-12);
}

TEST(OrderFit, LeavesOutWhatIsNotAsymptotic) {
  // saturates at 10
  const auto fit = fit_order(kSteps, errors_of([](double dt) { return dt <= 8 ? dt : 10 + 1e-3 * dt; }), 0);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 4);
  EXPECT_NEAR(fit->order, 1, 1e-12);
}

TEST(OrderFit, LeavesOutWhatTheConvergedSolutionCannotTell) {
  // an error of order 2 on top of the converged solution's own 1
  const auto fit = fit_order(kSteps, errors_of([](double dt) { return dt * dt + 1; }), 1);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->first, 2);
  EXPECT_EQ(fit->points, 4);
  EXPECT_NEAR(fit->order, 2, 0.05);
  EXPECT_FALSE(fit_order(kSteps, errors_of([](double dt) { return dt; }), 1));  // three steps left
}

TEST(OrderFit, NeedsErrors) {
  EXPECT_FALSE(fit_order(kSteps, errors_of([](double) { return 0.0; }), 0));
  EXPECT_FALSE(fit_order({}, {}, 0));
}

TEST(Quartiles, AreBetweenNeighbours) {
  const Quartiles of = quartiles_of({4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(of.lower, 1.75);
  EXPECT_DOUBLE_EQ(of.median, 2.5);
  EXPECT_DOUBLE_EQ(of.upper, 3.25);
  EXPECT_EQ(quartiles_of({7}).upper, 7);
}

}  // namespace
}  // namespace shaken::bench
