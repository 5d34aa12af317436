#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "run/files/directory.h"
#include "run/files/trajectory.h"

namespace shaken::web {

/// The trajectory.h5 of a run with two frames of one rod.
inline void record_two_frames(const run::RunDirectory& directory, const std::string& run) {
  const Cell cell{.box = 10, .gap = 1.2, .shapes = {{{-2, 0, 2}, {0.2, 0.4, 0.2}}}};
  auto log = run::FrameLog::create(directory.frames(), {1, cell, 1e-5, "{}", {run, 1}}).value();
  for (int k = 0; k < 2; ++k) {
    Snapshot now;
    now.tick = k;
    now.time = 0.1 * k;
    now.box = 10;
    now.position = now.velocity = {{1, 2, 0.6}};
    now.director = {{1, 0, 0}};
    now.image = {{0, 0}};
    ASSERT_TRUE(log.append(run::record(now)));
  }
  ASSERT_TRUE(log.sync());
  ASSERT_TRUE(
      run::write_trajectory(directory.trajectory(), run::TrajectoryReader::open(directory.frames())->recorded()));
  std::filesystem::remove(directory.frames());
}

}  // namespace shaken::web
