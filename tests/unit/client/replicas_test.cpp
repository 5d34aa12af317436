// SPDX-License-Identifier: MIT
#include "client/replicas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
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

/// What Python, the curves of plots and the page are held against, too.
TEST(ReplicaMean, IsThatOfAllThatTakeIt) {
  std::ifstream file(SHAKEN_SOURCE_DIR "/tests/vectors/replica_mean.json");
  for (const nlohmann::json& one : nlohmann::json::parse(file)) {
    const auto number = [](const nlohmann::json& value) { return value.is_null() ? kUnknown : value.get<double>(); };
    std::vector<double> sems;
    for (const nlohmann::json& sem : one.at("errors")) sems.push_back(number(sem));
    const Estimate result = replica_mean(one.at("values").get<std::vector<double>>(), sems);
    EXPECT_NEAR(result.value, one.at("mean").get<double>(), 1e-14) << one.at("why");
    if (const double error = number(one.at("error")); std::isnan(error)) {
      EXPECT_TRUE(std::isnan(result.sem)) << one.at("why");
    } else {
      EXPECT_NEAR(result.sem, error, 1e-14) << one.at("why");
    }
  }
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
