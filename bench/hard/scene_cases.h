// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/hard/outcome.h"
#include "scene/run_plan.h"
#include "sim/world.h"

namespace shaken::bench {

/// A hard case that is a scene file: DIR/NAME.json.
struct SceneCase {
  std::string name;
  std::string what;
  double max_overlap = 0.1;   ///< allowed, as a fraction of the thinnest bead's radius; 0.5 ends a run
  bool makes_energy = false;  ///< known to, although nothing shakes it: the law's fault
};
const std::vector<SceneCase>& scene_cases();

/// Reads DIR/NAME.json. Throws Failure if that cannot be done.
scene::RunPlan read_hard_scene(const std::filesystem::path& folder, const std::string& name);

/// Tick, rods and values.
std::string to_text(const NumericalTrouble& trouble);

/// Called now and then with the part of the work that is done.
using Watch = std::function<void(double)>;

/// Runs the scene to its end, or for `seconds` if that is sooner, and looks at it every 2 ms of its time.
HardCase run_scene_case(const SceneCase& wanted, const scene::RunPlan& plan, double seconds, const Watch& watch);

}  // namespace shaken::bench
