// SPDX-License-Identifier: MIT
#include "run/worker/progress_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace shaken::run {
namespace {

TEST(DescribeProgress, ShowsHowFarAndHowLong) {
  Progress progress;
  progress.sim_time = 5;
  progress.sim_time_total = 10;
  progress.sim_rate = 0.02;
  progress.eta = 250;
  progress.order = 0.913;
  EXPECT_EQ(describe_progress(progress),
            "████████████············  50.0 %  5 of 10 s  0.02 s/s  ETA 4 min 10 s  S 0.913");
  progress.state = "rendering";
  progress.drawn = 0.4;
  EXPECT_EQ(describe_progress(progress),
            "████████████············  50.0 %  5 of 10 s  drawing 40 %  ETA 4 min 10 s  S 0.913");
  progress.state = "stopped";
  EXPECT_EQ(describe_progress(progress), "████████████············  50.0 %  5 of 10 s  stopped  S 0.913");
  progress.order = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(describe_progress(progress), "████████████············  50.0 %  5 of 10 s  stopped") << "spheres";
}

}  // namespace
}  // namespace shaken::run
