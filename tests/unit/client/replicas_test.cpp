// SPDX-License-Identifier: MIT
#include "client/replicas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace shaken::client {
namespace {

constexpr double kUnknown = NAN;

TEST(StudentFactor, TabulatedValues) {
  EXPECT_NEAR(student_factor(2), 1.837, 0.025);
  EXPECT_NEAR(student_factor(3), 1.321, 0.002);
  EXPECT_NEAR(student_factor(5), 1.142, 0.001);
  EXPECT_NEAR(student_factor(11), 1.053, 0.001);
}

TEST(ReplicaMean, RunsThatHappenToAgreeAreNoBetterThanTheirOwnErrors) {
  const std::vector<double> values{0.9739, 0.9740}, sems{0.0018, 0.0039};
  const Estimate result = replica_mean(values, sems);
  EXPECT_DOUBLE_EQ(result.value, 0.97395);
  EXPECT_DOUBLE_EQ(result.sem, std::hypot(0.0018, 0.0039) / 2);
}

TEST(ReplicaMean, RunsThatDisagreeSayMoreThanTheirOwnErrors) {
  const std::vector<double> values{0.5, 0.7}, sems{0.001, 0.001};
  EXPECT_NEAR(replica_mean(values, sems).sem, 0.1, 1e-12);
}

TEST(ReplicaMean, WithoutOwnErrorsFewRunsAreWidened) {
  const std::vector<double> values{0.5, 0.7}, unknown{kUnknown, kUnknown}, one_known{kUnknown, 0.9};
  EXPECT_NEAR(replica_mean(values, unknown).sem, 0.1 * student_factor(2), 1e-12);
  EXPECT_DOUBLE_EQ(replica_mean(values, one_known).sem, 0.45) << "never below what is known";
}

TEST(ReplicaMean, OneRunHasItsOwnErrorOrNone) {
  const std::vector<double> value{0.5}, known{0.1}, unknown{kUnknown};
  EXPECT_DOUBLE_EQ(replica_mean(value, known).sem, 0.1);
  EXPECT_TRUE(std::isnan(replica_mean(value, unknown).sem));
}

/// Deviations of many means from the truth in units of their errors: mean square, and the part beyond one.
struct Calibration {
  double chi2_per_n = 0;
  double beyond_one = 0;
};
Calibration calibrate(std::size_t n_replicas, bool errors_known) {
  constexpr int kTrials = 20000;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Calibration result;
  std::vector<double> values(n_replicas);
  const std::vector<double> sems(n_replicas, errors_known ? 1.0 : kUnknown);
  for (int trial = 0; trial < kTrials; ++trial) {
    for (double& value : values) value = normal(random);
    const Estimate mean = replica_mean(values, sems);
    const double deviation = mean.value / mean.sem;
    result.chi2_per_n += deviation * deviation / kTrials;
    result.beyond_one += std::abs(deviation) > 1 ? 1.0 / kTrials : 0.0;
  }
  return result;
}

TEST(ReplicaMean, KnownErrorsAreCalibrated) {
  for (const std::size_t n : {2, 3, 5, 20}) {
    const double chi2 = calibrate(n, true).chi2_per_n;
    EXPECT_GT(chi2, 0.8) << n;
    EXPECT_LT(chi2, 1.25) << n;
  }
}

TEST(ReplicaMean, ErrorsFromScatterAloneHoldTwoThirds) {
  // The mean square would be endless for two runs (Cauchy's distribution); what counts is how many lie within.
  for (const std::size_t n : {2, 3, 5, 20}) EXPECT_NEAR(calibrate(n, false).beyond_one, 0.317, 0.02) << n;
}

}  // namespace
}  // namespace shaken::client
