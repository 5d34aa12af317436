#pragma once

#include <optional>
#include <string>

#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// Bytes that this process may have: of the machine's memory, of what limits its group (cgroup) and those around it,
/// and of `ulimit -v`, the least.
double memory_allowed();

/// That the measurements of `plan` would hold more than `allowed` bytes, if so: with the largest of them, and what
/// makes it smaller. `file` and, of a sweep's point, `label` are for the message.
std::optional<Problem> memory_problem(const RunPlan& plan, double allowed, const std::string& file,
                                      const std::string& label = {});

}  // namespace shaken::scene
