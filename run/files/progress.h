#pragma once

#include <filesystem>
#include <string>

#include "base/core/result.h"

namespace shaken::run {

/// What a worker tells of itself in progress.json, replaced atomically about twice a second. Files, because a worker
/// may run anywhere that shares the disk: under the daemon, alone, or as a task of a batch system.
struct Progress {
  std::string state = "running";  ///< running | rendering | done | failed | stopped
  std::string message;            ///< why it failed
  int pid = 0;
  int n_rods = 0;
  double sim_time = 0;            ///< [s]
  double sim_time_total = 0;      ///< [s]
  double sim_rate = 0;            ///< simulated seconds per wall second
  double eta = -1;                ///< wall seconds to the end of what it does now; negative where unknown
  double drawn = 0;               ///< share of the movie's frames that are drawn
  double order = 0;               ///< S now; NaN (null in the file) of spheres, which have none
  double order_running_mean = 0;  ///< over the second half of the run so far; NaN where it is not measured
  double max_overlap = 0;         ///< [mm]

  double fraction() const { return sim_time_total > 0 ? sim_time / sim_time_total : 0.0; }
};

Result<void> write_progress(const std::filesystem::path& file, const Progress& progress);
Result<Progress> read_progress(const std::filesystem::path& file);

}  // namespace shaken::run
