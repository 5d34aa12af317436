// SPDX-License-Identifier: MIT
#include "run/terminal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shaken::run {
namespace {

TEST(DescribeDuration, PicksItsUnits) {
  EXPECT_EQ(describe_duration(3.25), "3.2 s");
  EXPECT_EQ(describe_duration(59.4), "59 s");
  EXPECT_EQ(describe_duration(250), "4 min 10 s");
  EXPECT_EQ(describe_duration(7500), "2 h 05 min");
  EXPECT_EQ(describe_duration(3 * 86400 + 4 * 3600), "3 d 4 h");
  EXPECT_EQ(describe_duration(-1), "unknown");
  EXPECT_EQ(describe_duration(std::nan("")), "unknown");
}

TEST(DescribeProgress, ShowsHowFarAndHowLong) {
  Progress progress;
  progress.sim_time = 5;
  progress.sim_time_total = 10;
  progress.sim_rate = 0.02;
  progress.eta = 250;
  progress.order = 0.913;
  EXPECT_EQ(describe_progress(progress),
            "[############------------]  50.0 %  5 of 10 s  0.02 s/s  ETA 4 min 10 s  S 0.913");
  progress.state = "stopped";
  EXPECT_EQ(describe_progress(progress), "[############------------]  50.0 %  5 of 10 s  stopped  S 0.913");
}

}  // namespace
}  // namespace shaken::run
