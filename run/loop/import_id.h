#pragma once

#include <string>

#include "scene/keys/run_plan.h"
#include "sim/simulation.h"

namespace shaken::run {

/// The scene of imported rods: `plan` without what it says of where rods start.
scene::RunPlan without_start(scene::RunPlan plan);

/// 16 hex digits that name rods that come from a file: XXH3-64 of the run id of without_start(plan) and of the state of
/// all rods. As with other runs, neither `stream` nor how long the scene goes on has a part in it.
std::string import_id(const scene::RunPlan& plan, const Simulation& simulation);

}  // namespace shaken::run
