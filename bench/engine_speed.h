// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "bench/case.h"
#include "bench/report.h"

namespace shaken::bench {

/// How long and how often to measure.
struct Effort {
  double cpu = 1.5;  ///< CPU time of one timed stretch, about [s]
  int repeat = 5;
};

/// What one engine did in the timed stretch of a case, and how long it took in each repetition.
struct EngineSpeed {
  Tick ticks = 0;            ///< length of the stretch
  std::vector<double> cpu;   ///< CPU time of each repetition, all threads together [s]
  std::vector<double> wall;  ///< and on the wall [s]
  double rod_seconds = 0;    ///< simulated in the stretch
  std::int64_t plate_impulses = 0;
  std::int64_t rod_impulses = 0;  ///< between rods
  double bytes_per_rod = 0;       ///< memory of state and stepper
  double max_overlap = 0;         ///< deepest since the start of the run [mm]

  double best_cpu() const;  ///< least disturbed by whatever else ran on the machine
  double best_wall() const;
  double spread() const;  ///< median CPU time over the best
  double wall_spread() const;
  double rate() const { return rod_seconds / best_cpu(); }  ///< rod-seconds per CPU-second
  std::int64_t impulses() const { return plate_impulses + rod_impulses; }
};

/// How many ticks take about `cpu` seconds by `engine`: whole vibrations if it is at least one, as speed changes with
/// the plates' phase.
Tick ticks_for(double cpu, const Case& of, const SteadyState& state, Engine engine);

/// Steps on by `ticks` and adds one repetition to `speed`; everything else in it is set anew.
void time_stretch(Simulation& simulation, const Case& of, Tick ticks, EngineSpeed& speed);

/// As members of a report's row.
Json json_of(const Case& scene);
Json json_of(const EngineSpeed& speed);

}  // namespace shaken::bench
