// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

namespace shaken::scene {

/// JSON Schemas (draft 2020-12, with no keyword that editors of draft 7 need and lack), made from the table of fields.
/// They say of each key its meaning, unit, range and default. What load_scene and load_sweep accept they accept too.
/// The reverse does not hold: a schema knows nothing of keys that contradict each other, of the range of a quantity
/// that is written with a unit, of comments (which are allowed), and of duplicate keys.

/// What load_scene reads.
nlohmann::ordered_json scene_schema();

/// What load_sweep reads: sweep files, and scenes.
nlohmann::ordered_json sweep_schema();

}  // namespace shaken::scene
