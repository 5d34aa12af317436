// SPDX-License-Identifier: MIT
#include "analysis/decay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shaken::analysis {
namespace {

TEST(DecayTime, OfAnExponentialIsExactOnCoarseLags) {
  for (const double tau : {0.3, 1.0, 1.7, 5.9}) {
    EstimateCurve curve;
    const std::vector<double> lags{1, 2, 4, 6};
    for (const double t : lags) curve.push_back({std::exp(-t / tau), 0.01});
    const Estimate found = decay_time(lags, curve);
    EXPECT_NEAR(found.value, tau, 1e-12);
    EXPECT_NEAR(found.sem, 0.01 * tau * std::exp(1.0), 1e-12);  // slope 1 / (e tau)
  }
}

TEST(DecayTime, OfACurveThatGoesNegativeIsLinearInBetween) {
  const Estimate found = decay_time(std::vector<double>{0, 1, 2}, {{1, 0.9, -0.1}, {0, 0.02, 0.01}});
  EXPECT_NEAR(found.value, 1 + 0.9 - std::exp(-1.0), 1e-12);
  EXPECT_NEAR(found.sem, 0.02, 1e-12);
}

TEST(DecayTime, IsUnknownWhereItDoesNotFall) {
  EXPECT_TRUE(std::isnan(decay_time({}, {}).value));
  EXPECT_TRUE(std::isnan(decay_time(std::vector<double>{1, 2}, {{0.9, 0.5}, {0, 0}}).value));
  EXPECT_TRUE(std::isnan(decay_time(std::vector<double>{0, 1}, {{NAN, NAN}, {0, 0}}).value));
}

}  // namespace
}  // namespace shaken::analysis
