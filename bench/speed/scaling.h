// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bench/speed/engine_speed.h"
#include "bench/speed/scene_speed.h"

namespace shaken::bench {

/// The scheduled engine's cost along a series of scenes that differ in one thing.
struct Scaling {
  enum class Of { kRods, kStep };
  struct Point {
    Case scene;
    EngineSpeed speed;
    double cost() const { return 1 / speed.rate(); }  ///< CPU-seconds per rod-second
  };
  Of of = Of::kRods;
  std::vector<Point> points;

  /// The cost at point k over that at the first.
  double relative(std::size_t k) const { return points[k].cost() / points.front().cost(); }
};

/// Times the scenes in turn, `repeat` times, each from its own steady state.
Scaling measure_scaling(Scaling::Of of, const std::vector<Case>& scenes, const std::vector<SteadyState>& states,
                        const Effort& effort);

}  // namespace shaken::bench
