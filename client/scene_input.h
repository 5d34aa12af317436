#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/keys/problem.h"
#include "client/live/json.h"
#include "scene/sweeps/sweep.h"

namespace shaken::client {

/// A scene or sweep file as the user named it.
struct SceneInput {
  std::string file;  ///< for messages
  std::string text;
};

/// Reads a file, or stdin where `file` is "-". Throws Failure (kBadInput) if it cannot be read.
SceneInput read_scene_input(const std::string& file);

/// All points that the input asks for, rods placed. Throws Failure (kBadInput) with every problem.
scene::Sweep load_points(const SceneInput& input, const std::vector<std::string>& settings,
                         std::optional<int> replicas);

/// "refused, with 2 problems" and a line for each.
std::string refusal_text(const std::vector<keys::Problem>& problems);

/// What follows from a point's scene, besides its parameters: id, n_rods, area_fraction (both of all rods together),
/// species (name, count and area_fraction of each), gamma (null without gravity), amplitude_mm, sim_seconds, ticks,
/// trajectory_frames, measurement_memory_bytes (all measurements together when they hold most), remarks
/// (scene/remarks.h).
Json derived_quantities(const scene::SweepPoint& point);

}  // namespace shaken::client
