#pragma once

#include <filesystem>

#include "run/loop/loop.h"
#include "scene/keys/run_plan.h"

namespace shaken::run {

/// So many rods of 2.5 mm in a box of so many millimetres, of which order, angles, tilts and defects are measured, and
/// frames recorded.
inline scene::RunPlan small_plan(int n_rods = 24, double side = 12) {
  scene::RunPlan plan;
  plan.system.rod.n_beads = 7;
  plan.system.rod.length = 2.5;
  plan.system.n_rods = n_rods;
  plan.system.box_side = side;
  plan.system.dt = 2e-5;
  plan.measure_time = 0.3;
  plan.order = scene::MeasureOrder{0.002};
  plan.angles = scene::MeasureAngles{0.004, 36};
  plan.tilt = scene::MeasureTilt{0.001, 10};
  plan.defects = scene::MeasureDefects{0.02, 1.25, 0.3125};
  plan.trajectory = scene::Trajectory{0.01};
  return plan;
}

/// A run of the job "job" in this folder.
inline RunOptions options_in(const std::filesystem::path& folder) {
  RunOptions options;
  options.directory = folder;
  options.job_id = "job";
  return options;
}

}  // namespace shaken::run
