// What a run directory holds of its run: the plan, and the state in which it was last saved.
#pragma once

#include <limits>

#include "base/core/result.h"
#include "base/core/types.h"
#include "run/files/directory.h"
#include "scene/keys/run_plan.h"
#include "sim/simulation.h"

namespace shaken::run {

/// The plan of scene.json.
Result<scene::RunPlan> read_plan(const RunDirectory& directory);

/// A simulation of `system` that goes on from the newest checkpoint of run `run_id` that is whole, fits, and lies
/// before `before`. Fails with what is wrong with the newest if none does.
Result<Simulation> resume_last(const RunDirectory& directory, const std::string& run_id, const System& system,
                               Tick before = std::numeric_limits<Tick>::max());

}  // namespace shaken::run
