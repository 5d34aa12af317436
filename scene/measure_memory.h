// SPDX-License-Identifier: MIT
// What the measurements of a run will hold in memory, before anything is run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/keys.h"
#include "scene/run_plan.h"

namespace shaken::scene {

/// The bytes of one measurement.
struct MeasureMemory {
  std::string name;    ///< as in scene/observables.h
  double state = 0;    ///< what it has gathered at the end of the run; all of it goes into each checkpoint
  double scratch = 0;  ///< what it needs besides while it takes a sample
};

/// Of everything that the plan measures. Within a factor of two of what is held, wherever that is more than 2 MB;
/// where it depends on what the rods do (`defects.list`), that of disordered rods, which have the most defects.
std::vector<MeasureMemory> measure_memory(const RunPlan& plan);

/// Bytes that all measurements hold together when they hold most: their states, and on top either the copy of them
/// that a checkpoint is written from, or the scratch of one.
double peak_of(const std::vector<MeasureMemory>& memory);

/// Bytes that this process may have: of the machine's memory, of what limits its group (cgroup) and those around it,
/// and of `ulimit -v`, the least.
double memory_allowed();

/// The files that limit the memory of a process in a group and in those around it; `line`: of /proc/self/cgroup, of
/// version 2 ("0::/a/b") or 1 ("4:memory:/a/b"). None if the line is about something else.
std::vector<std::filesystem::path> cgroup_limits(const std::string& line);

/// That the measurements of `plan` would hold more than `allowed` bytes, if so: with the largest of them, and what
/// makes it smaller. `file` and, of a sweep's point, `label` are for the message.
std::optional<Problem> memory_problem(const RunPlan& plan, double allowed, const std::string& file,
                                      const std::string& label = {});

}  // namespace shaken::scene
