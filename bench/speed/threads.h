// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "bench/speed/engine_speed.h"
#include "bench/speed/scene_speed.h"

namespace shaken::bench {

/// The scheduled engine on one scene by several numbers of threads.
struct ThreadsSpeed {
  struct Point {
    int threads = 1;
    EngineSpeed speed;
    std::uint64_t hash = 0;  ///< of the state at the end; the same for all
  };
  Case scene;
  std::vector<Point> points;

  /// Wall time of the first point over that of point k.
  double speed_up(std::size_t k) const { return points.front().speed.best_wall() / points[k].speed.best_wall(); }
  bool hashes_equal() const;
};

/// Times the numbers of threads in turn, `repeat` times, always from the same state.
ThreadsSpeed measure_threads(const Case& scene, const SteadyState& state, const std::vector<int>& threads,
                             const Effort& effort);

}  // namespace shaken::bench
