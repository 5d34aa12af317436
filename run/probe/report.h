// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "run/probe/probe.h"

namespace shaken::run {

/// What a plan calls for and, if it was probed, what that costs; what `shaken-worker --probe` writes:
///   {"effects": [{"name", "what", "on", "why", "cpu_share"?, "note"?}],
///    "probe":  {"warm_up_s", "simulated_s", "cpu_s", "rod_seconds_per_cpu_second"},
///    "stages": [{"name", "what", "cpu_share"}],  "snapshots_cpu_share", "checkpoints_cpu_share",
///    "cpu_seconds", "stepping_cpu_seconds", "disk_bytes": {"trajectory", "observables", "checkpoints", "total"}}
/// All shares are of "cpu_seconds", the CPU time of the whole run with its movie. They overlap: friction is part of the
/// stages plates and response.
nlohmann::ordered_json probe_report(const scene::RunPlan& plan, const std::optional<Probe>& probe);

}  // namespace shaken::run
