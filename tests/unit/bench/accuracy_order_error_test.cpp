// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "base/core/rng.h"
#include "bench/accuracy/accuracy.h"

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
  const Json of = reduce_order(box(12), {correlated(memory, 40'000, 1), correlated(memory, 40'000, 2)}, every, 0.004);
  const double tau = every * (0.5 + memory / (1 - memory));  // half the sum over all lags, both signs
  const double found_tau = of.at("tau_s"), std = of.at("std"), c = of.at("c");
  EXPECT_NEAR(found_tau, tau, 0.1 * tau);
  EXPECT_NEAR(std, 0.02, 0.001);
  EXPECT_NEAR(of.at("mean"), 0.9, 0.002);
  EXPECT_NEAR(c, std, 0.15 * std);
  EXPECT_NEAR(of.at("sem").at(0), std, 1e-12) << "stretches of one sample";
  const double cpu = of.at("cpu_s_for_sem").at("0.001");
  EXPECT_DOUBLE_EQ(cpu, 2 * found_tau * std::pow(c / 0.001, 2) * box(12).system().n_rods * 0.004);
  EXPECT_NEAR(of.at("cpu_s_for_sem").at("0.0001").get<double>() / cpu, 100, 1e-9) << "one more digit";
  EXPECT_NEAR(of.at("expected_scatter"), c / std::sqrt(200 / (2 * found_tau)), 1e-12);
}

TEST(OrderError, PowerLawsAreContinued) {
  std::vector<Json> measured;
  for (const double side : {12.0, 15.0, 20.0, 25.0}) {
    measured.push_back(
        {{"side_mm", side}, {"std", 0.3 / side}, {"tau_s", 0.01 * std::sqrt(side)}, {"cpu_s_per_rod_s", 0.004}});
  }
  const Json large = extrapolate(measured, box(50));
  EXPECT_NEAR(large.at("std_power"), -1, 1e-9);
  EXPECT_NEAR(large.at("tau_power"), 0.5, 1e-9);
  const double time = 2 * 0.01 * std::sqrt(50) * std::pow(0.3 / 50 / 0.001, 2);
  EXPECT_NEAR(large.at("time_s_for_sem_0.001"), time, 1e-6 * time);
  EXPECT_NEAR(large.at("cpu_s_for_sem_0.001"), time * box(50).system().n_rods * 0.004, 1e-6 * time * 1000);
  measured.pop_back();
  EXPECT_TRUE(extrapolate(measured, box(50)).is_null()) << "too few boxes";
}

}  // namespace
}  // namespace shaken::bench
