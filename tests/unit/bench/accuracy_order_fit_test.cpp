// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/accuracy/order_fit.h"
#include "bench/accuracy/quartiles.h"

namespace shaken::bench {
namespace {

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
