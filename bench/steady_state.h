// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "bench/case.h"
#include "sim/simulation.h"

namespace shaken::bench {

/// A case after its warm-up.
struct SteadyState {
  std::vector<std::byte> checkpoint;
  bool was_cached = false;  ///< read from the cache, not simulated now
};

/// $XDG_CACHE_HOME/shaken/bench, or ~/.cache/shaken/bench.
std::filesystem::path default_cache();

/// The state of `wanted` after its warm-up: from `cache`, or simulated now and kept there. A file's name and content
/// bear the hash of all that the state depends on, so that a damaged one, or one of another scene, is made anew.
SteadyState steady_state(const Case& wanted, const std::filesystem::path& cache);

/// A simulation that goes on from a steady state by either engine.
Simulation resumed(const Case& of, const SteadyState& state, Engine engine);

/// Steps on by `ticks`. Throws Failure on numerical trouble.
void advance(Simulation& simulation, Tick ticks);

}  // namespace shaken::bench
