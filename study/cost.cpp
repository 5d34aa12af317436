// SPDX-License-Identifier: MIT
#include "study/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/table.h"
#include "base/text.h"

namespace shaken::study {
namespace {

using Align = Table::Align;

/// A task takes Slurm about a second, whatever it does [s].
constexpr double kShortTask = 60;

/// scene.json, observables.h5, summary.json, progress.json, both checkpoints, worker.log, lock.
constexpr std::size_t kFilesOfEveryRun = 8;

/// "2G", as Slurm counts [bytes]
double bytes_of(const std::string& memory) {
  double bytes = std::stod(memory);
  for (const char unit : std::string_view("KMGT")) {
    bytes *= 1024;
    if (memory.back() == unit) break;
  }
  return bytes;
}

std::string cores_text(const StudyCost& cost) {
  if (cost.cores > 0) return fmt::format("{} core{}", cost.cores, cost.cores == 1 ? "" : "s");
  return "as many cores as there are tasks";
}

}  // namespace

double two_digits(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double step = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  return std::round(value / step) * step;
}

std::size_t n_files_of(const scene::RunPlan& plan) {
  return kFilesOfEveryRun + (plan.trajectory || plan.movie ? 1 : 0) + (plan.movie ? 1 : 0);
}

StudyCost study_cost(const std::vector<const NamedSweep*>& sweeps,
                     const std::vector<std::vector<client::RunCost>>& runs, int cores) {
  StudyCost study;
  study.slurm = std::any_of(sweeps.begin(), sweeps.end(),
                            [](const NamedSweep* sweep) { return sweep->sweep.executor == "slurm"; });
  study.cores = cores;
  if (cores == 0 && !study.slurm) study.cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  double most_besides = 0;
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const NamedSweep& sweep = *sweeps[k];
    Cost cost{.n_runs = sweep.sweep.points.size(), .rod_seconds = sweep.rod_seconds()};
    cost.load = {.runs_per_task = std::max(1, sweep.sweep.slurm.runs_per_task),
                 .cores = study.cores,
                 .time_limit = sweep.sweep.slurm.time};
    double besides = 0;
    for (const client::RunCost& run : runs[k]) {
      cost.load.runs.push_back(run.cpu);
      cost.disk += run.disk;
      cost.memory = std::max(cost.memory, run.memory);
      besides = std::max(besides, run.most - run.disk);
    }
    for (const scene::SweepPoint& point : sweep.sweep.points) cost.n_files += n_files_of(point.plan);
    cost.estimate = client::estimate_in_slurm(cost.load);
    cost.longest_run = cost.estimate.run;
    const auto at_once = [&](const Cost& of) {
      const auto tasks = static_cast<double>(of.estimate.n_tasks);
      return study.cores > 0 ? std::min<double>(study.cores, tasks) : tasks;
    };
    cost.room = cost.disk + at_once(cost) * besides;

    // together the tasks of all sweeps stand in one queue
    const std::vector<double> tasks = client::tasks_of(cost.load);
    Cost& all = study.all;
    all.load.runs.insert(all.load.runs.end(), tasks.begin(), tasks.end());
    all.n_runs += cost.n_runs;
    all.rod_seconds += cost.rod_seconds;
    all.disk += cost.disk;
    all.memory = std::max(all.memory, cost.memory);
    all.n_files += cost.n_files;
    all.longest_run = std::max(all.longest_run, cost.longest_run);
    most_besides = std::max(most_besides, besides);
    all.load.cores = study.cores;
    all.estimate = client::estimate_in_slurm(all.load);
    all.room = all.disk + at_once(all) * most_besides;
    study.sweeps.push_back({.name = sweep.name, .slurm = sweep.sweep.slurm, .cost = std::move(cost)});
  }
  if (!study.slurm) {  // the daemon starts the next run here at once
    study.all.estimate.refill = 0;
    for (SweepCost& sweep : study.sweeps) sweep.cost.estimate.refill = 0;
  }
  return study;
}

StudyCost probed_cost(const std::vector<NamedSweep>& sweeps, const client::EstimateOptions& options, int cores,
                      const client::Console& console) {
  std::vector<const NamedSweep*> probed;
  std::vector<std::vector<client::RunCost>> runs;
  for (const NamedSweep& sweep : sweeps) {
    if (!sweep.needed) continue;
    if (console.err_is_terminal) console.err << fmt::format("\r\x1b[Kwhat will it cost? {}", sweep.name) << std::flush;
    probed.push_back(&sweep);
    runs.push_back(client::estimate_cost(sweep.sweep, options).runs);
  }
  if (console.err_is_terminal) console.err << "\r\x1b[K" << std::flush;
  return study_cost(probed, runs, cores);
}

std::string cost_text(const StudyCost& study, int width) {
  std::vector<Table::Column> columns{{"SWEEP"},
                                     {"RUNS", Align::kRight},
                                     {"ROD-SECONDS", Align::kRight, 3},
                                     {"CORE-HOURS", Align::kRight},
                                     {"LONGEST RUN", Align::kRight},
                                     {"WALL TIME", Align::kRight},
                                     {"MEMORY", Align::kRight, 1},
                                     {"DISK", Align::kRight}};
  if (study.slurm) columns.insert(columns.begin() + 4, {"TASKS", Align::kRight, 2});
  Table table(columns);
  const auto add = [&](const std::string& name, const Cost& cost) {
    Row row{name,
            std::to_string(cost.n_runs),
            number_text(cost.rod_seconds),
            number_text(two_digits(cost.estimate.core_hours)),
            duration_text(cost.longest_run),
            duration_text(cost.estimate.all()),
            bytes_text(cost.memory),
            bytes_text(cost.disk)};
    if (study.slurm) row.insert(row.begin() + 4, std::to_string(cost.estimate.n_tasks));
    table.add_row(std::move(row));
  };
  for (const SweepCost& sweep : study.sweeps) add(sweep.name, sweep.cost);
  add("together", study.all);
  std::string text = table.text(width) +
                     fmt::format("Wall time is that on {} like this machine's{}; memory is that of the largest run.\n",
                                 cores_text(study), study.slurm ? ", without waiting for others' jobs" : "");
  for (const std::string& remark : remarks_on(study)) text += remark + "\n";
  return text;
}

Json cost_json(const StudyCost& study, const std::string& scale) {
  const auto json = [&](const Cost& cost) {
    Json members{{"runs", cost.n_runs},
                 {"rod_seconds", cost.rod_seconds},
                 {"cpu_seconds", 3600 * cost.estimate.core_hours},
                 {"longest_run_s", cost.longest_run},
                 {"wall_s", cost.estimate.all()},
                 {"memory_bytes", cost.memory},
                 {"disk_bytes", cost.disk},
                 {"disk_room_bytes", cost.room},
                 {"files", cost.n_files}};
    if (study.slurm) members.update({{"tasks", cost.estimate.n_tasks}, {"longest_task_s", cost.estimate.task}});
    return members;
  };
  Json all{{"scale", scale},
           {"executor", study.slurm ? "slurm" : "local"},
           {"cores", study.cores > 0 ? Json(study.cores) : Json(nullptr)},
           {"sweeps", Json::array()}};
  for (const SweepCost& sweep : study.sweeps) {
    all["sweeps"].push_back({{"sweep", sweep.name}});
    all["sweeps"].back().update(json(sweep.cost));
  }
  all.update(json(study.all));
  all["remarks"] = remarks_on(study);
  return all;
}

std::vector<std::string> remarks_on(const StudyCost& study) {
  std::vector<std::string> remarks;
  if (!study.slurm) return remarks;
  std::string long_ones, small_ones;
  const auto name = [](std::string& names, const std::string& sweep) { names += (names.empty() ? "" : ", ") + sweep; };
  for (const SweepCost& sweep : study.sweeps) {
    if (sweep.cost.estimate.too_long) name(long_ones, sweep.name);
    if (!sweep.slurm.memory.empty() && sweep.cost.memory > bytes_of(sweep.slurm.memory)) name(small_ones, sweep.name);
  }
  if (!long_ones.empty()) {
    remarks.push_back("Tasks take longer than they may (" + long_ones +
                      "): what is left then goes on from its checkpoint in another task.");
  }
  if (!small_ones.empty()) {
    remarks.push_back("Runs may need more memory than their tasks have (" + small_ones + "): ask for more (--memory).");
  }
  const double mean =
      3600 * study.all.estimate.core_hours / static_cast<double>(std::max<std::size_t>(1, study.all.estimate.n_tasks));
  if (mean < kShortTask && study.all.n_runs > 1) {
    remarks.push_back(
        "Tasks of less than a minute are mostly Slurm's own work: put more runs into each (--runs-per-task).");
  }
  return remarks;
}

}  // namespace shaken::study
