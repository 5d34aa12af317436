#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/keys/fields.h"
#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// The resolved scene: every key that matters, derived ones too, numbers in default units. Reading it again gives the
/// identical plan.
nlohmann::ordered_json to_json(const RunPlan& plan);

/// 16 hex digits that name a run: XXH3-64 of the physics version (sim/physics_version.h) and of the canonical
/// scene without `stream`, and without what says how long it goes on: `time.measure` and `until`. So a longer run of
/// the same scene is the same run, extended.
std::string run_id(const RunPlan& plan);

/// The same with `time.measure` and `until`: tells scenes apart that differ in the length of their runs only, which is
/// for estimates and benches.
std::string scene_hash(const RunPlan& plan);

}  // namespace shaken::scene
