#include "client/slurm_estimate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>

#include "base/failure.h"
#include "base/text.h"
#include "scene/sweeps/sweep_keys.h"

namespace shaken::client {
namespace {

/// Wall time of each task: so many runs one after the other, in their order.
std::vector<double> tasks_of(const SlurmLoad& load) {
  const auto per_task = static_cast<std::size_t>(load.runs_per_task);
  std::vector<double> tasks((load.runs.size() + per_task - 1) / per_task);
  // a tick that threads share takes as much CPU time, or more
  for (std::size_t run = 0; run < load.runs.size(); ++run) tasks[run / per_task] += load.runs[run] / load.threads;
  return tasks;
}

/// When the last of these tasks ends if they are started in their order, `at_once` of them at most at the same time.
double end_of_last(const std::vector<double>& tasks, std::size_t at_once) {
  std::priority_queue<double, std::vector<double>, std::greater<>> ends;  // of those that run, the next one first
  double last = 0;
  for (const double task : tasks) {
    double begin = 0;
    if (ends.size() >= at_once) {
      begin = ends.top();
      ends.pop();
    }
    ends.push(begin + task);
    last = std::max(last, begin + task);
  }
  return last;
}

}  // namespace

bool is_slurm(const std::string& executor) {
  const std::vector<std::string>& known = scene::sweep_keys().at("executor").names;
  if (!executor.empty() && std::find(known.begin(), known.end(), executor) == known.end()) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("--executor: '{}' is none of {}", printable(executor), fmt::join(known, ", ")));
  }
  return executor == "slurm";
}

SlurmEstimate estimate_in_slurm(const SlurmLoad& load) {
  SlurmEstimate estimate;
  const std::vector<double> tasks = tasks_of(load);
  estimate.n_tasks = tasks.size();
  if (tasks.empty()) return estimate;
  estimate.run = *std::max_element(load.runs.begin(), load.runs.end()) / load.threads;
  estimate.task = *std::max_element(tasks.begin(), tasks.end());
  estimate.core_hours = std::accumulate(load.runs.begin(), load.runs.end(), 0.0) / 3600;
  const std::size_t at_once =
      load.cores > 0 ? static_cast<std::size_t>(std::max(1, load.cores / load.threads)) : tasks.size();
  estimate.wall = end_of_last(tasks, at_once);
  estimate.refill = static_cast<double>(estimate.n_tasks) / load.max_pending * load.poll;
  if (static_cast<int>(estimate.n_tasks) <= load.max_pending) estimate.refill = 0;
  estimate.too_long = load.time_limit > 0 && estimate.task > load.time_limit;
  return estimate;
}

std::string slurm_estimate_text(const SlurmLoad& load, const SlurmEstimate& estimate) {
  std::string text = fmt::format(
      "In Slurm, on cores like this machine's: {} core-hours, in {} tasks of up to {} runs, about {} the longest.\n",
      number_text(estimate.core_hours), estimate.n_tasks, load.runs_per_task, duration_text(estimate.task));
  text += fmt::format("With {} at once it takes {}",
                      load.cores > 0 ? fmt::format("{} cores", load.cores) : std::string("all tasks"),
                      duration_text(estimate.all()));
  if (estimate.refill > estimate.wall) {
    text += fmt::format(": the daemon hands over {} tasks (--max-pending) every {} at most", load.max_pending,
                        duration_text(load.poll));
  }
  text += "; waiting for others' jobs is not in it.\n";
  constexpr double kShort = 60;
  if (estimate.task < kShort && load.runs.size() > static_cast<std::size_t>(load.runs_per_task)) {
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
          {"longest_run_s", estimate.run},
          {"task_s", estimate.task},
          {"cores", load.cores > 0 ? Json(load.cores) : Json(nullptr)},
          {"max_pending", load.max_pending},
          {"wall_s", estimate.all()},
          {"longer_than_time", estimate.too_long}};
}

}  // namespace shaken::client
