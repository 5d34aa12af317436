// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/case.h"
#include "bench/speed/engine_speed.h"
#include "bench/speed/scene_speed.h"
#include "bench/steady_state.h"

namespace shaken::bench {

/// One way to simulate, whose speed is compared with another's.
struct Contender {
  std::string name;
  Case scene;
  /// A simulation that is past its warm-up. Made anew for each repetition.
  std::function<Simulation()> make;
};

/// CPU times of a contender and of the one that it is compared with, taken in turn.
struct Comparison {
  std::string name;
  EngineSpeed speed;      ///< of the contender
  EngineSpeed yardstick;  ///< of the other, in the same repetitions

  /// CPU time per rod-second of the contender over that of the yardstick, by the best repetition of each.
  double ratio() const;
  /// Its standard error, from the scatter of the ratios of single repetitions; 0 for one.
  double error() const;
};

/// Steps both for equal simulated times, one after the other, `effort.repeat` times.
Comparison compare(const Contender& contender, const Contender& yardstick, const Effort& effort);

/// An effect of the scene, and what leaving it out changes.
struct Saving {
  std::string effect;
  std::string neutral;     ///< the key and value with which it is off
  Comparison comparison;   ///< without the effect, against everything on
  std::string impossible;  ///< why such a scene cannot be, if so
};

/// Switches off every effect of the case that can be off, one at a time. Each of these scenes has a warm-up of its own
/// (kept in `cache`), so what is compared is how they go on, not how they begin.
std::vector<Saving> measure_savings(const Case& everything, const std::filesystem::path& cache, const Effort& effort);

}  // namespace shaken::bench
