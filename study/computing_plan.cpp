// SPDX-License-Identifier: MIT
#include "study/computing_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/failure.h"
#include "base/files.h"
#include "base/processor.h"
#include "base/text.h"
#include "run/files/version.h"
#include "sim/core/physics_version.h"

namespace shaken::study {
namespace {

namespace fs = std::filesystem;

constexpr double kMinute = 60, kHour = 3600, kDay = 24 * kHour;
/// Cores of a cluster may be slower than those of this machine, and runs may differ from those that were probed.
constexpr double kMargin = 1.5;
/// As the worker and the daemon do it.
constexpr double kProgressPerSecond = 2, kCheckpointPeriod = 30;

/// An estimate is good to two digits at best.
std::string time_text(double seconds) {
  if (seconds < 1.5 * kMinute) return number_text(two_digits(seconds)) + " s";
  if (seconds < 1.5 * kHour) return number_text(two_digits(seconds / kMinute)) + " min";
  if (seconds < 2 * kDay) return number_text(two_digits(seconds / kHour)) + " h";
  return number_text(two_digits(seconds / kDay)) + " d";
}
std::string size_text(double bytes) { return bytes_text(two_digits(bytes)); }

/// What is to be asked for, with the margin, rounded up; as `--time` takes it.
std::string time_to_ask(double seconds) {
  const double with_margin = kMargin * seconds;
  const double quarter = 15 * kMinute;
  if (with_margin <= 4 * quarter) {
    return fmt::format("{:.0f}min", std::max(1.0, std::ceil(with_margin / quarter)) * quarter / kMinute);
  }
  return fmt::format("{:.0f}h", std::ceil(with_margin / kHour));
}
/// As `--memory` takes it, in steps of a quarter of a GiB.
std::string memory_to_ask(double bytes) {
  constexpr double kStep = 256, kMebibyte = 1024.0 * 1024;
  return fmt::format("{:.0f}M", std::max(1.0, std::ceil(kMargin * bytes / kMebibyte / kStep)) * kStep);
}

/// A word for a shell's command line.
std::string shell_word(const std::string& word) {
  const bool is_plain = word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./+") ==
                        std::string::npos;
  if (is_plain && !word.empty()) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// "figure 8", "figures 2 and 6", "figures 2, 6 and 8".
std::string figures_text(const Selection& selection) {
  std::vector<std::string> ids;
  for (const PaperFigure* figure : selection.figures) ids.emplace_back(figure->id());
  if (ids.empty()) return "no figures";
  const std::string last = ids.back();
  ids.pop_back();
  if (ids.empty()) return "figure " + last;
  return fmt::format("figures {} and {}", fmt::join(ids, ", "), last);
}

double longest_task_of(const StudyCost& study) {
  double longest = 0;
  for (const SweepCost& sweep : study.sweeps) longest = std::max(longest, sweep.cost.estimate.task);
  return longest;
}

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
  const int threads = study.sweeps.front().cost.load.threads;
  const auto n_tasks = static_cast<double>(all.estimate.n_tasks);
  const double most = n_tasks * threads;  // cores that can be used
  const double cores = study.cores > 0 ? std::min<double>(study.cores, most) : most;
  const double at_once = std::min(n_tasks, cores / threads);
  const double longest_task = longest_task_of(study);
  int runs_per_task = 1;
  for (const SweepCost& sweep : study.sweeps) runs_per_task = std::max(runs_per_task, sweep.cost.load.runs_per_task);
  std::string table = "| | |\n|---|---|\n";
  const auto row = [&](const char* what, const std::string& value) {
    table += fmt::format("| {} | {} |\n", what, value);
  };
  row("runs", fmt::format("{}, each a program of its own; none talks to another", all.n_runs));
  row("jobs", fmt::format("about {} in job arrays, one node each, {}", counted(all.estimate.n_tasks, "task"),
                          runs_per_task == 1 ? "with one run in each"
                                             : fmt::format("with up to {} runs one after the other", runs_per_task)));
  row("cores", fmt::format("{} for each task; {:.0f} at once{}", threads, cores,
                           cores < most ? fmt::format(", and up to {:.0f} can be used", most)
                                        : ", as many as there are tasks for"));
  row("core-hours", number_text(two_digits(all.estimate.core_hours)));
  row("wall time of the longest run", time_text(all.longest_run));
  row("wall time of the longest task", time_text(longest_task));
  row("wall time of everything", fmt::format("{}, with {} at once", time_text(all.estimate.all()),
                                             counted(static_cast<std::size_t>(cores), "core")));
  row("time to ask for, of a task",
      fmt::format("{}: the longest and half as much again; less only makes more tasks", time_to_ask(longest_task)));
  row("memory of a task", size_text(all.memory) + " at most");
  row("memory to ask for, of a task",
      fmt::format("{}: that and half as much again, in steps of 256M", memory_to_ask(all.memory)));
  row("storage", fmt::format("{} when all is done; {} while it runs", size_text(all.disk), size_text(all.room)));
  row("files", fmt::format("{} at most, in {}; besides two small ones for each task while it is out", all.n_files,
                           counted(all.n_runs, "folder")));
  row("input and output",
      fmt::format(
          "each run at work replaces a file of 1 kB twice a second and writes a checkpoint every 30 s: {} small "
          "files and {} checkpoints a second in all; its results grow as it goes on",
          number_text(two_digits(kProgressPerSecond * at_once)), number_text(two_digits(at_once / kCheckpointPeriod))));
  row("network", "none between nodes; all nodes see one folder");
  row("a process on a login node",
      fmt::format("the daemon `shakend`, for as long as all of this takes ({} and the waiting for nodes): see below",
                  time_text(all.estimate.all())));
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
    table += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, cost.n_runs, cost.estimate.n_tasks,
                         number_text(two_digits(cost.estimate.core_hours)), time_text(cost.longest_run),
                         time_text(cost.estimate.all()), size_text(cost.memory), size_text(cost.disk), cost.n_files);
  };
  for (const SweepCost& sweep : study.sweeps) row(sweep.name, sweep.cost);
  row("all", study.all);
  return table;
}

/// How the sweeps come to ask for what the table says, where they do not yet.
std::string asking_text(const StudyCost& study) {
  std::string options;
  const auto add = [&](bool is_asked, const std::string& option) {
    if (!is_asked) options += (options.empty() ? "" : " ") + option;
  };
  const auto all_ask = [&](auto asks) { return std::all_of(study.sweeps.begin(), study.sweeps.end(), asks); };
  add(all_ask([](const SweepCost& sweep) { return sweep.slurm.time > 0; }),
      "--time " + time_to_ask(longest_task_of(study)));
  add(all_ask([](const SweepCost& sweep) { return !sweep.slurm.memory.empty(); }),
      "--memory " + memory_to_ask(study.all.memory));
  if (options.empty()) return "The sweeps ask Slurm for the time and the memory of the table by themselves.\n";
  return fmt::format(
      "The sweeps ask Slurm for what the table says is asked for, and no more. Made again with `{}`, this plan has "
      "sweeps\n"
      "that ask for what it advises.\n",
      options);
}

}  // namespace

fs::path sweeps_beside(const fs::path& file) { return file.parent_path() / (file.stem().string() + "-sweeps"); }

std::string computing_plan(const Selection& selection, const StudyCost& study, const std::string& command,
                           const std::string& sweeps) {
  std::string submits;
  for (const SweepCost& sweep : study.sweeps) {
    submits += fmt::format("    shaken --root ROOT submit {}\n", shell_word(sweeps + "/" + sweep.name + ".json"));
  }
  std::string remarks;
  for (const std::string& remark : remarks_on(study)) remarks += fmt::format("\n- {}", remark);
  if (!remarks.empty()) remarks = "To think of:\n" + remarks + "\n\n";
  return fmt::format(
      R"(# Computing plan: shaken granular rods

Simulations of rods between two vibrating plates, with the program Shaken {version} (physics {physics}).
They give {figures} of `shaken figures`, after Sharma & Soni, Soft Matter 20, 6608 (2024).

## What is asked for

{request}
Times, core-hours and sizes are estimates, rounded to two digits, for cores like that of the machine where this plan was made
({cpu}): of each sweep at most {probes} runs were started there for a second or two, and the others interpolated. Waiting
for others' jobs is not in them. Memory is what such a piece of a run takes, and what its measurements may grow to.

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
  computes nothing: it hands tasks over, at most 100 that wait, and asks Slurm every 10 s. It must live until all is
  done, beyond the login that started it. Should it end, runs that are in Slurm go on, and the same command started
  again finds them; what was not handed over yet waits for it.
- A folder that this node and all others see at the same path, with file locks (flock) that hold between nodes, for the
  runs (ROOT below) and for Shaken's programs.
- Shaken {version}, built with g++ 12 or newer and CMake: on Debian 12 `./dev build` installs what is missing. Libraries
  at run time: HDF5, SQLite, LCM, fmt, spdlog, RE2, xxHash; for films, OSMesa and those of ffmpeg. gnuplot draws the
  figures, at any time and on any machine that sees the folder.

## How it is run

Names of files are as seen from the folder of this plan, to which `{folder}` belongs; ROOT is the path of the folder for
the runs, from `/`. In the folder of Shaken's source, once:

    cmake --install build/release --prefix /shared/shaken && export PATH=/shared/shaken/bin:$PATH

In the folder of this plan, on the login node:

    mkdir -p ROOT
    shaken doctor --root ROOT --executor slurm        # whether all of this is there
    nohup shakend --root ROOT --executor slurm > /dev/null 2>&1 &    # its log is ROOT/shakend.log
{submits}    shaken --root ROOT status                         # how far it is; `shaken cancel`, `hold`, `retry` act on it
    {command}

Where what `nohup` has started ends with the login all the same, start the daemon within `tmux`, or (after `loginctl
enable-linger`) with `systemd-run --user --unit=shakend shakend --root ROOT --executor slurm`.

{asking})",
      fmt::arg("version", run::version()), fmt::arg("physics", kPhysicsVersion),
      fmt::arg("figures", figures_text(selection)), fmt::arg("request", request_table(study)),
      fmt::arg("cpu", printable(cpu_name())), fmt::arg("probes", client::kMostProbes), fmt::arg("remarks", remarks),
      fmt::arg("sweeps", sweep_table(study)), fmt::arg("folder", sweeps), fmt::arg("submits", submits),
      fmt::arg("command", command), fmt::arg("asking", asking_text(study)));
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
