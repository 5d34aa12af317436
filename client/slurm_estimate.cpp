// SPDX-License-Identifier: MIT
#include "client/slurm_estimate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/failure.h"
#include "base/text.h"
#include "scene/slurm_settings.h"

namespace shaken::client {

bool is_slurm(const std::string& executor) {
  const std::vector<std::string>& known = scene::executor_names();
  if (!executor.empty() && std::find(known.begin(), known.end(), executor) == known.end()) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("--executor: '{}' is none of {}", printable(executor), fmt::join(known, ", ")));
  }
  return executor == "slurm";
}

SlurmEstimate estimate_in_slurm(const SlurmLoad& load) {
  SlurmEstimate estimate;
  const auto per_task = static_cast<std::size_t>(load.runs_per_task);
  estimate.n_tasks = (load.n_runs + per_task - 1) / per_task;
  if (estimate.n_tasks == 0) return estimate;
  const double run = load.cpu / static_cast<double>(load.n_runs);
  const auto longest = static_cast<double>(std::min(per_task, load.n_runs));
  // a tick that threads share takes as much CPU time, or more
  estimate.task = longest * run / load.threads;
  estimate.core_hours = load.cpu / 3600;
  const std::size_t at_once =
      load.cores > 0 ? static_cast<std::size_t>(std::max(1, load.cores / load.threads)) : estimate.n_tasks;
  estimate.wall = std::ceil(static_cast<double>(estimate.n_tasks) / static_cast<double>(at_once)) * estimate.task;
  estimate.refill = static_cast<double>(estimate.n_tasks) / load.max_pending * load.poll;
  if (static_cast<int>(estimate.n_tasks) <= load.max_pending) estimate.refill = 0;
  estimate.too_long = load.time_limit > 0 && estimate.task > load.time_limit;
  return estimate;
}

std::string slurm_estimate_text(const SlurmLoad& load, const SlurmEstimate& estimate) {
  std::string text = fmt::format(
      "In Slurm, on cores like this machine's: {} core-hours, in {} tasks of up to {} runs, about {} each.\n",
      number_text(estimate.core_hours), estimate.n_tasks, load.runs_per_task, duration_text(estimate.task));
  text += fmt::format("With {} at once it takes {}",
                      load.cores > 0 ? fmt::format("{} cores", load.cores) : std::string("all tasks"),
                      duration_text(std::max(estimate.wall, estimate.refill)));
  if (estimate.refill > estimate.wall) {
    text += fmt::format(": the daemon hands over {} tasks (--max-pending) every {} at most", load.max_pending,
                        duration_text(load.poll));
  }
  text += "; waiting for others' jobs is not in it.\n";
  constexpr double kShort = 60;
  if (estimate.task < kShort && load.n_runs > static_cast<std::size_t>(load.runs_per_task)) {
    text += "Tasks of less than a minute are mostly Slurm's own work: put more runs into each (slurm.runs_per_task).\n";
  }
  if (estimate.too_long) {
    text += fmt::format(
        "A task takes longer than slurm.time, {}: what is left then goes on from its checkpoint in another.\n",
        duration_text(load.time_limit));
  }
  return text;
}

Json slurm_estimate_json(const SlurmLoad& load, const SlurmEstimate& estimate) {
  return {{"n_tasks", estimate.n_tasks},
          {"runs_per_task", load.runs_per_task},
          {"core_hours", estimate.core_hours},
          {"task_s", estimate.task},
          {"cores", load.cores > 0 ? Json(load.cores) : Json(nullptr)},
          {"max_pending", load.max_pending},
          {"wall_s", std::max(estimate.wall, estimate.refill)},
          {"longer_than_time", estimate.too_long}};
}

}  // namespace shaken::client
