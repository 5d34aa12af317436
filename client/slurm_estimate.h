#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "client/live/json.h"

namespace shaken::client {

/// What is known of a sweep that is to run in Slurm.
struct SlurmLoad {
  std::vector<double> runs{};  ///< CPU time of each, in their order, on a core like that of this machine [s]
  int runs_per_task = 1;
  int threads = 1;        ///< cores of a task
  int cores = 0;          ///< that run at once; 0: as many as there are tasks for
  int max_pending = 100;  ///< tasks that wait in Slurm's queue at most
  double poll = 10;       ///< from one question of the daemon to the next [s]
  double time_limit = 0;  ///< of a task [s]; 0: none that is known
};

/// What it comes to. Waiting for others' jobs is not in it.
struct SlurmEstimate {
  std::size_t n_tasks = 0;
  double core_hours = 0;
  double run = 0;         ///< wall time of the longest run [s]
  double task = 0;        ///< wall time of the longest task [s]
  double wall = 0;        ///< of the sweep, each core taking the next task when it has done one [s]
  double refill = 0;      ///< least time in which the daemon hands all tasks over [s]
  bool too_long = false;  ///< a task takes longer than it may

  /// The time of the sweep, with the daemon's handing over [s].
  double all() const { return std::max(wall, refill); }
};

/// Whether a value of --executor means Slurm; none means that of the scene's sweep or the daemon. Throws Failure where
/// it is the name of no executor.
bool is_slurm(const std::string& executor);

SlurmEstimate estimate_in_slurm(const SlurmLoad& load);
/// For people, some lines.
std::string slurm_estimate_text(const SlurmLoad& load, const SlurmEstimate& estimate);
Json slurm_estimate_json(const SlurmLoad& load, const SlurmEstimate& estimate);

}  // namespace shaken::client
