#pragma once

#include <nlohmann/json.hpp>

namespace shaken::scene {

/// The JSON Schema (base/keys/schema.h) of what load_scene reads.
nlohmann::ordered_json scene_schema();

/// That of what load_sweep reads: sweep files, and scenes.
nlohmann::ordered_json sweep_schema();

}  // namespace shaken::scene
