// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "bench/case.h"
#include "bench/speed/engine_speed.h"
#include "bench/speed/lower_bounds.h"
#include "bench/steady_state.h"

namespace shaken::bench {

/// How long and how often to measure.
struct Effort {
  double cpu = 1.5;  ///< CPU time of one timed stretch, about [s]
  int repeat = 5;
};

/// Everything measured on one scene.
struct SceneSpeed {
  Case scene;
  bool was_cached = false;  ///< its steady state
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

  double ratio() const { return scheduled.rate() / reference.rate(); }
  bool hashes_equal() const { return scheduled_hash == reference_hash; }
};

/// Both engines in turn, `repeat` times, each time from the same steady state; then the phases and the bounds.
SceneSpeed measure_scene(const Case& scene, const SteadyState& state, const Effort& effort);

}  // namespace shaken::bench
