// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "bench/accuracy/order_error.h"
#include "sim/core/rng.h"

namespace shaken::bench {
namespace {

Case box(double side) { return make_case(4.5, 0.75, side, kPaperStep, 1); }

/// A series whose correlation falls by `memory` from sample to sample, of variance 0.02^2 about 0.9.
std::vector<double> correlated(double memory, int n, std::uint64_t seed) {
  Rng rng(seed, RngStream::kVelocity, 0, 0);
  std::vector<double> values;
  double x = rng.normal();
  for (int k = 0; k < n; ++k) {
    values.push_back(0.9 + 0.02 * x);
    x = memory * x + std::sqrt(1 - memory * memory) * rng.normal();
  }
  return values;
}

TEST(OrderError, OfASeriesWithAKnownCorrelationTime) {
  const double memory = std::exp(-1 / 20.0);
  const double every = 0.005;
  const OrderError of = reduce_order(box(12), {correlated(memory, 40'000, 1), correlated(memory, 40'000, 2)}, every);
  const double tau = every * (0.5 + memory / (1 - memory));  // half the sum over all lags, both signs
  EXPECT_NEAR(of.tau, tau, 0.1 * tau);
  EXPECT_NEAR(of.std, 0.02, 0.001);
  EXPECT_NEAR(of.mean, 0.9, 0.002);
  ASSERT_TRUE(of.c);
  EXPECT_NEAR(of.c->value, of.std, 0.15 * of.std);
  EXPECT_NEAR(of.errors.front().sem, of.std, 1e-12) << "stretches of one sample";
  EXPECT_DOUBLE_EQ(of.time_for(0.001), 2 * of.tau * std::pow(of.c->value / 0.001, 2));
  EXPECT_NEAR(of.time_for(0.0001) / of.time_for(0.001), 100, 1e-9) << "one more digit";
  EXPECT_NEAR(of.expected_scatter(), of.c->value / std::sqrt(200 / (2 * of.tau)), 1e-12);
}

TEST(OrderError, PowerLawsAreContinued) {
  std::vector<OrderError> measured;
  for (const double side : {12.0, 15.0, 20.0, 25.0}) {
    OrderError of;
    of.scene = box(side);
    of.std = 0.3 / side;
    of.tau = 0.01 * std::sqrt(side);
    of.cpu_per_rod_second = 0.004;
    measured.push_back(of);
  }
  const auto large = extrapolate(measured, box(50));
  ASSERT_TRUE(large);
  EXPECT_NEAR(large->std.order, -1, 1e-9);
  EXPECT_NEAR(large->tau.order, 0.5, 1e-9);
  const double time = 2 * 0.01 * std::sqrt(50) * std::pow(0.3 / 50 / 0.001, 2);
  EXPECT_NEAR(large->time_for(0.001), time, 1e-6 * time);
  EXPECT_NEAR(large->cpu_for(0.001), time * box(50).system().n_rods * 0.004, 1e-6 * time * 1000);
  measured.pop_back();
  EXPECT_FALSE(extrapolate(measured, box(50))) << "too few boxes";
}

}  // namespace
}  // namespace shaken::bench
