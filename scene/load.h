#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// Reads a scene file (docs/scene.md) and applies `settings` ("path=value") to it in their order. `file` is the name
/// used in problems. Everything that is wrong is listed at once.
Loaded<RunPlan> load_scene(std::string_view text, const std::string& file, std::span<const std::string> settings = {});

}  // namespace shaken::scene
