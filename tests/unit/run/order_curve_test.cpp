// SPDX-License-Identifier: MIT
#include "run/files/order_curve.h"

#include <gtest/gtest.h>

#include "base/scratch_folder.h"
#include "run/files/observables_file.h"

namespace shaken::run {
namespace {

const BeadRow kRod{{-2, 0, 2}, {0.2, 0.4, 0.2}};
const BeadRow kSphere{{0}, {0.4}};

/// `n_frames` frames 0.1 s apart of two rods, the second of which turns by 90 degrees in the last one.
void record_rods(const RunDirectory& directory, int n_frames, const BeadRow& beads = kRod) {
  const Cell cell{.box = 10, .gap = 1.2, .shapes = {beads}};
  auto log = FrameLog::create(directory.frames(), {2, cell, 1e-5, "{}", {}}).value();
  for (int k = 0; k < n_frames; ++k) {
    Snapshot now;
    now.tick = k;
    now.time = 0.1 * k;
    now.box = 10;
    now.position = now.velocity = {{1, 2, 0.6}, {7, 8, 0.6}};
    now.director = {{1, 0, 0}, k + 1 < n_frames ? Vec3(1, 0, 0) : Vec3(0, 1, 0)};
    now.image = {{0, 0}, {0, 0}};
    ASSERT_TRUE(log.append(record(now)));
  }
}

TEST(OrderCurve, IsThatOfEvenlyChosenFrames) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  record_rods(directory, 9);
  const OrderCurve all = recorded_order(directory, 100).value();
  EXPECT_EQ(all.times.size(), 9u);
  EXPECT_NEAR(all.orders.front(), 1, 1e-6);
  EXPECT_NEAR(all.orders.back(), 0, 1e-6) << "rods across each other";
  const OrderCurve some = recorded_order(directory, 3).value();
  ASSERT_EQ(some.times.size(), 3u);
  EXPECT_DOUBLE_EQ(some.times[0], 0);
  EXPECT_NEAR(some.times[1], 0.4, 1e-12);
  EXPECT_NEAR(some.times[2], 0.8, 1e-12);
  EXPECT_NEAR(recorded_order(directory, 1)->times.at(0), 0.8, 1e-12);
  record_rods(directory, 0);
  EXPECT_TRUE(recorded_order(directory, 3)->times.empty());
}

TEST(OrderCurve, SpheresHaveNone) {
  const ScratchFolder folder;
  record_rods({folder.path()}, 3, kSphere);
  EXPECT_TRUE(recorded_order({folder.path()}, 10)->times.empty());
}

TEST(OrderCurve, WithoutFramesItIsThatOfTheObservables) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  EXPECT_FALSE(recorded_order(directory, 3));
  ASSERT_TRUE(write_observables(directory.observables(), {{"/order/time_s", {1, 2}}, {"/order/order", {0.5, 0.25}}}));
  const OrderCurve curve = recorded_order(directory, 3).value();
  EXPECT_EQ(curve.times, (std::vector<double>{1, 2}));
  EXPECT_EQ(curve.orders, (std::vector<double>{0.5, 0.25}));
}

}  // namespace
}  // namespace shaken::run
