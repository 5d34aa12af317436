// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "client/json.h"

namespace shaken::client {

/// What is known of a sweep that is to run in Slurm.
struct SlurmLoad {
  std::size_t n_runs = 0;
  double cpu = 0;  ///< of all runs together, on a core like that of this machine [s]
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
  double task = 0;        ///< wall time of a task [s]
  double wall = 0;        ///< of the sweep, in rounds of as many tasks as there are cores [s]
  double refill = 0;      ///< least time in which the daemon hands all tasks over [s]
  bool too_long = false;  ///< a task takes longer than it may
};

/// Whether a value of --executor means Slurm; none means that of the scene's sweep or the daemon. Throws Failure where
/// it is the name of no executor.
bool is_slurm(const std::string& executor);

SlurmEstimate estimate_in_slurm(const SlurmLoad& load);
/// For people, some lines.
std::string slurm_estimate_text(const SlurmLoad& load, const SlurmEstimate& estimate);
Json slurm_estimate_json(const SlurmLoad& load, const SlurmEstimate& estimate);

}  // namespace shaken::client
