#pragma once

#include <gtest/gtest.h>

#include "run/files/directory.h"
#include "run/files/trajectory.h"

namespace shaken::test {

inline const BeadRow kRod{{-2, 0, 2}, {0.2, 0.4, 0.2}};

/// `n_frames` frames, some seconds apart, of two rods in a box of 10 mm, of which the second turns by 90 degrees in the
/// last one: what a run has recorded by then.
inline void record_rods(const run::RunDirectory& directory, int n_frames, const BeadRow& beads = kRod,
                        double apart = 0.1) {
  const Cell cell{.box = 10, .gap = 1.2, .shapes = {beads}};
  auto log = run::FrameLog::create(directory.frames(), {2, cell, 1e-5, "{}", {}}).value();
  for (int k = 0; k < n_frames; ++k) {
    Snapshot now;
    now.tick = k;
    now.time = apart * k;
    now.box = 10;
    now.position = now.velocity = {{1, 2, 0.6}, {7, 8, 0.6}};
    now.director = {{1, 0, 0}, k + 1 < n_frames ? Vec3(1, 0, 0) : Vec3(0, 1, 0)};
    now.image = {{0, 0}, {0, 0}};
    ASSERT_TRUE(log.append(run::record(now)));
  }
  ASSERT_TRUE(log.sync());
}

}  // namespace shaken::test
