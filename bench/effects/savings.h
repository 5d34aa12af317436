// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
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

/// Steps both, one after the other, `repeat` times. `periods`: so many vibrations each time; 0: as many as take about
/// `cpu` seconds.
Comparison compare(const Contender& contender, const Contender& yardstick, int repeat, int periods, double cpu);

/// An effect of the scene, and what leaving it out changes.
struct Saving {
  std::string effect;
  std::string neutral;  ///< the key and value with which it is off
  /// Without the effect, against everything on, each from a warm-up of its own: what a user gains.
  Comparison own_state;
  /// The same for the next few vibrations of one and the same state, before the rods have parted ways: what it takes to
  /// compute the effect. Not for effects without which that state could not be.
  std::optional<Comparison> same_state;
  std::string impossible;  ///< why such a scene cannot be, if so
};

/// Switches off every effect of the case that can be off, one at a time. States after a warm-up are kept in `cache`.
std::vector<Saving> measure_savings(const Case& everything, const std::filesystem::path& cache, const Effort& effort);

}  // namespace shaken::bench
