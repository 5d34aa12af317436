// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/engine_speed.h"
#include "bench/lower_bounds.h"
#include "bench/report.h"

namespace shaken::bench {

/// How figures of speed came about.
struct Conditions {
  Effort effort;
  double warm_up = 0;  ///< [s]
  /// Shorter than this, the rods still stand much as they were placed: figures are then not of the steady state.
  static constexpr double kSteady = 5.0;
  bool steady() const { return warm_up >= kSteady; }
};

/// With the conditions, but no rows yet.
Report report_under(const Conditions& conditions, const std::string& file_name, const std::string& bench);
/// What a scene is, at the beginning of each line of a table, and these columns.
std::vector<Column> scene_columns(const std::vector<Column>& more);

/// Both engines on one scene.
struct SceneSpeed {
  Case scene;
  EngineSpeed scheduled;
  EngineSpeed reference;
  /// Hash of the state after the reference's stretch, by either engine. They must be equal.
  std::uint64_t scheduled_hash = 0;
  std::uint64_t reference_hash = 0;
  Tick compared_ticks = 0;  ///< from the steady state to that hash
  /// CPU time of the scheduled engine's phases, from a run of their own, and the whole of that run [s].
  std::array<double, kPhases> phases{};
  double phases_cpu = 0;
  LowerBounds bounds;

  bool hashes_equal() const { return scheduled_hash == reference_hash; }
};

/// Both engines in turn, `repeat` times, each time from the same steady state; then the phases and the bounds.
SceneSpeed measure_scene(const Case& scene, const SteadyState& state, const Effort& effort);
Report speed_report(const Conditions& conditions, const std::vector<SceneSpeed>& scenes);

/// The scheduled engine's cost along a series of scenes that differ in their number of rods or in their step.
enum class Scaling { kRods, kStep };
struct ScalingPoint {
  Case scene;
  EngineSpeed speed;
};

/// Times the scenes in turn, `repeat` times, each from its own steady state.
std::vector<ScalingPoint> measure_scaling(const std::vector<Case>& scenes, const Cache& cache, const Effort& effort);
Report scaling_report(const Conditions& conditions, Scaling of, const std::vector<ScalingPoint>& points);
void draw_scaling(const std::filesystem::path& folder, Scaling of, const Report& report);

/// The scheduled engine on one scene by several numbers of threads.
struct ThreadsPoint {
  int threads = 1;
  EngineSpeed speed;
  std::uint64_t hash = 0;  ///< of the state at the end; the same for all
};
struct ThreadsSpeed {
  Case scene;
  std::vector<ThreadsPoint> points;

  bool hashes_equal() const;
};

/// Times the numbers of threads in turn, `repeat` times, always from the same state.
ThreadsSpeed measure_threads(const Case& scene, const SteadyState& state, const std::vector<int>& threads,
                             const Effort& effort);
Report threads_report(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes);

}  // namespace shaken::bench
