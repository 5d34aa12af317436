#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/keys/keys.h"
#include "scene/sweeps/sweep.h"

namespace shaken::scene {

/// The problem that the simulation cannot place the rods of `plan`, if so. It is asked: this costs as much as a start.
/// Only a start that is compressed, which takes CPU seconds, is left to the run.
/// `file` and, of a sweep's point, `label` are for the message.
std::optional<Problem> placement_problem(const RunPlan& plan, const std::string& file, const std::string& label = {});

/// load_sweep for runs that are to be started: also every point whose rods cannot be placed is a problem, and
/// every one whose measurements take more memory than this machine has (scene/memory_limit.h).
Loaded<Sweep> load_runs(std::string_view text, const std::string& file, std::span<const std::string> settings = {},
                        std::optional<int> replicas = std::nullopt);

}  // namespace shaken::scene
