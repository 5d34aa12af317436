// SPDX-License-Identifier: MIT
#include "run/live/pace.h"

#include <gtest/gtest.h>

namespace shaken::run {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Pacer, ComesRoundOncePerPeriod) {
  const WallClock::time_point start{};
  Pacer pacer(WallSeconds(0.5), start);
  EXPECT_TRUE(pacer.take(start));
  EXPECT_FALSE(pacer.take(start));
  EXPECT_FALSE(pacer.take(start + milliseconds(499)));
  EXPECT_TRUE(pacer.take(start + milliseconds(500)));
  EXPECT_TRUE(pacer.take(start + seconds(60))) << "late";
  EXPECT_FALSE(pacer.take(start + seconds(60) + milliseconds(1))) << "what was missed is not made up for";
}

TEST(RateMeter, KnowsAConstantRateAtOnce) {
  const WallClock::time_point start{};
  RateMeter meter(100.0, start);
  EXPECT_EQ(meter.rate(), 0);
  EXPECT_LT(meter.eta(200), 0) << "unknown";
  for (int i = 1; i <= 20; ++i) {
    meter.update(100.0 + 0.25 * i, start + milliseconds(500 * i));
    EXPECT_NEAR(meter.rate(), 0.5, 1e-12);
  }
  EXPECT_NEAR(meter.eta(110), 10, 1e-9);
}

TEST(RateMeter, IsNotFooledByCallsInQuickSuccession) {
  const WallClock::time_point start{};
  RateMeter meter(0, start);
  meter.update(0, start + milliseconds(1));
  meter.update(1, start + seconds(1));
  EXPECT_NEAR(meter.rate(), 1, 1e-12);
  meter.update(1, start + seconds(1) + milliseconds(1));
  EXPECT_NEAR(meter.rate(), 1, 1e-12);
}

TEST(RateMeter, FollowsAChangeWithinTenSeconds) {
  const WallClock::time_point start{};
  RateMeter meter(0, start);
  double sim = 0;
  for (int i = 1; i <= 120; ++i) meter.update(sim += 1, start + seconds(i));
  for (int i = 121; i <= 135; ++i) meter.update(sim += 0.1, start + seconds(i));
  EXPECT_NEAR(meter.rate(), 0.1, 0.1);
}

}  // namespace
}  // namespace shaken::run
