// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/keys.h"
#include "scene/run_plan.h"

namespace shaken::scene {

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
