// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/machine.h"
#include "bench/speed/scaling.h"
#include "bench/speed/scene_speed.h"
#include "bench/speed/threads.h"

namespace shaken::bench {

/// How the figures of a report came about.
struct Conditions {
  Machine machine;
  Effort effort;
  double warm_up = 0;  ///< [s]
  /// Shorter than this, the rods still stand much as they were placed: figures are then not of the steady state.
  static constexpr double kSteady = 5.0;
  bool steady() const { return warm_up >= kSteady; }
};

/// Each kind of measurement as text for people, as JSON and CSV for programs, and as a picture.
std::string as_text(const Conditions& conditions, const std::vector<SceneSpeed>& scenes);
std::string as_text(const Conditions& conditions, const Scaling& scaling);
std::string as_text(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes);

nlohmann::ordered_json as_json(const Conditions& conditions, const std::vector<SceneSpeed>& scenes);
nlohmann::ordered_json as_json(const Conditions& conditions, const Scaling& scaling);
nlohmann::ordered_json as_json(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes);

/// CSV of a JSON report's rows, in the order of their keys; what is nested is named with dots.
std::string as_csv(const nlohmann::ordered_json& rows);

void draw_scenes(const std::filesystem::path& folder, const std::vector<SceneSpeed>& scenes);
void draw_scaling(const std::filesystem::path& folder, const Scaling& scaling);

}  // namespace shaken::bench
