#pragma once

#include <filesystem>

#include "base/core/result.h"
#include "scene/keys/run_plan.h"
#include "sim/simulation.h"

namespace shaken::run {

/// The simulation at tick 0 that a run of `plan` begins with: rods placed as the scene says or, with `start`, as the
/// run named there has left them. That run is looked for in the folder of `directory`, the run's own, and then among
/// the daemon's (base/paths.h). Fails if it is not there, or has no state saved at that time, or does not fit.
/// A compressed start asks `go_on` (sim/start/compression.h).
Result<Simulation> start_simulation(const scene::RunPlan& plan, const std::filesystem::path& directory,
                                    const GoOn& go_on = {});

}  // namespace shaken::run
