// SPDX-License-Identifier: MIT
#include "study/computing_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/failure.h"
#include "base/files.h"
#include "base/processor.h"
#include "base/text.h"
#include "run/files/version.h"
#include "sim/core/physics_version.h"

namespace shaken::study {
namespace {

namespace fs = std::filesystem;

/// What all sweeps ask for alike, or that they differ.
template <class Member>
std::string asked(const StudyCost& study, const std::string& nothing, Member text_of) {
  const std::string first = text_of(study.sweeps.front());
  const bool alike = std::all_of(study.sweeps.begin(), study.sweeps.end(),
                                 [&](const SweepCost& sweep) { return text_of(sweep) == first; });
  if (!alike) return "differs from sweep to sweep";
  return first.empty() ? nothing : first;
}

std::string request_table(const StudyCost& study) {
  const Cost& all = study.all;
  const std::string cores = study.cores > 0 ? fmt::format("{} cores at once", study.cores) : "all tasks at once";
  std::string table = "| | |\n|---|---|\n";
  const auto row = [&](const char* what, const std::string& value) {
    table += fmt::format("| {} | {} |\n", what, value);
  };
  row("runs", fmt::format("{}, each a program of its own; none talks to another", all.n_runs));
  row("jobs",
      fmt::format(
          "about {} tasks in job arrays, one node each, at most {} runs one after the other in a task",
          all.estimate.n_tasks,
          std::max_element(study.sweeps.begin(), study.sweeps.end(), [](const SweepCost& a, const SweepCost& b) {
            return a.cost.load.runs_per_task < b.cost.load.runs_per_task;
          })->cost.load.runs_per_task));
  row("cores of a task", std::to_string(study.sweeps.front().cost.load.threads));
  row("core-hours", number_text(all.estimate.core_hours));
  row("wall time of the longest run", duration_text(all.longest_run));
  double longest_task = 0;
  for (const SweepCost& sweep : study.sweeps) longest_task = std::max(longest_task, sweep.cost.estimate.task);
  row("wall time of the longest task", duration_text(longest_task));
  row("wall time of everything", fmt::format("{}, with {}", duration_text(all.estimate.all()), cores));
  row("memory of a task", bytes_text(all.memory) + " at most");
  row("storage", fmt::format("{} when all is done; {} while it runs", bytes_text(all.disk), bytes_text(all.room)));
  row("files", fmt::format("{} at most, in {} folders; besides two small ones for each task while it is out",
                           all.n_files, all.n_runs));
  row("network", "none between nodes; all nodes see one folder");
  row("GPUs, MPI, licences", "none");
  row("partition", asked(study, "the cluster's own", [](const SweepCost& sweep) { return sweep.slurm.partition; }));
  row("account", asked(study, "the user's own", [](const SweepCost& sweep) { return sweep.slurm.account; }));
  row("time limit asked for", asked(study, "that of the partition", [](const SweepCost& sweep) {
        return sweep.slurm.time > 0 ? duration_text(sweep.slurm.time) : std::string();
      }));
  row("memory asked for",
      asked(study, "that of the partition", [](const SweepCost& sweep) { return sweep.slurm.memory; }));
  return table;
}

std::string sweep_table(const StudyCost& study) {
  std::string table =
      "| sweep | runs | tasks | core-hours | longest run | alone, wall time | memory | storage | files |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  const auto row = [&](const std::string& name, const Cost& cost) {
    table +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, cost.n_runs, cost.estimate.n_tasks,
                    number_text(cost.estimate.core_hours), duration_text(cost.longest_run),
                    duration_text(cost.estimate.all()), bytes_text(cost.memory), bytes_text(cost.disk), cost.n_files);
  };
  for (const SweepCost& sweep : study.sweeps) row(sweep.name, sweep.cost);
  row("all", study.all);
  return table;
}

}  // namespace

fs::path sweeps_beside(const fs::path& file) { return file.parent_path() / (file.stem().string() + "-sweeps"); }

std::string computing_plan(const Selection& selection, const StudyCost& study, const std::string& command,
                           const std::string& sweeps) {
  std::string figures;
  for (const PaperFigure* figure : selection.figures) {
    figures += (figures.empty() ? "" : ", ") + std::string(figure->id);
  }
  std::string submits;
  for (const SweepCost& sweep : study.sweeps) {
    submits += fmt::format("    shaken --root ROOT submit {}/{}.json\n", sweeps, sweep.name);
  }
  std::string remarks;
  for (const std::string& remark : remarks_on(study)) remarks += fmt::format("\n- {}", remark);
  if (!remarks.empty()) remarks = "To think of:\n" + remarks + "\n\n";
  return fmt::format(
      R"(# Computing plan: shaken granular rods

Simulations of rods between two vibrating plates, with the program Shaken {version} (physics {physics}). They give
the figures {figures} of `shaken figures`, after Sharma & Soni, Soft Matter 20, 6608 (2024).

## What is asked for

{request}
Times and core-hours are estimates for cores like that of the machine where this plan was made ({cpu}): of each
sweep at most {probes} runs were started there for a second or two, and the others interpolated. Waiting for others' jobs
is not in them. Memory is what such a piece of a run takes, and what its measurements may grow to.

{remarks}## Sweeps

{sweeps}
A sweep is a file with the physical settings of its runs, in the folder `{folder}` beside this plan.

## How it restarts

- Every run writes a checkpoint about every 30 s and at its end: exact state, so that a run that was stopped gives bit
  for bit what it would have given without.
- Tasks may be preempted, put back (`scontrol requeue`) or ended by a time limit at any time. Before a time limit they
  get a signal ahead (`--signal=B:USR1`), write a checkpoint, and what is left goes on in another task. A time limit
  that is shorter than the longest run therefore costs nothing but a further task.
- A node that fails costs what its runs have done since their last checkpoints. Nothing is computed twice: runs that are
  done are found done when a sweep is submitted again.

## What is needed

- Slurm with job arrays; `sbatch`, `squeue` and `scancel` where the daemon `shakend` runs, most often a login node. It
  computes nothing: it hands tasks over, and asks Slurm every 10 s.
- A folder that this node and all others see at the same path, with file locks (flock) that hold between nodes, for the
  runs (ROOT below) and for Shaken's programs.
- Shaken {version}, built with g++ 12 or newer and CMake: on Debian 12 `./dev build` installs what is missing. Libraries
  at run time: HDF5, SQLite, LCM, fmt, spdlog, RE2, xxHash; for films, OSMesa and those of ffmpeg. gnuplot draws the
  figures, at any time and on any machine that sees the folder.

## How it is run

    cmake --install build/release --prefix /shared/shaken
    shaken doctor --root ROOT --executor slurm        # whether all of this is there
    shakend --root ROOT --executor slurm &
{submits}    shaken --root ROOT status                         # how far it is; `shaken cancel`, `hold`, `retry` act on it
    {command}
)",
      fmt::arg("version", run::version()), fmt::arg("physics", kPhysicsVersion), fmt::arg("figures", figures),
      fmt::arg("request", request_table(study)), fmt::arg("cpu", printable(cpu_name())),
      fmt::arg("probes", client::kMostProbes), fmt::arg("remarks", remarks), fmt::arg("sweeps", sweep_table(study)),
      fmt::arg("folder", sweeps), fmt::arg("submits", submits), fmt::arg("command", command));
}

void write_computing_plan(const Selection& selection, const StudyCost& cost, const std::string& command,
                          const fs::path& file) {
  const fs::path folder = sweeps_beside(file);
  done_or_fail(make_folder(folder));
  for (const NamedSweep& sweep : selection.sweeps) {
    if (sweep.needed) done_or_fail(write_file_atomically(folder / (sweep.name + ".json"), sweep.input.text));
  }
  done_or_fail(write_file_atomically(file, computing_plan(selection, cost, command, folder.filename().string())));
}

}  // namespace shaken::study
