// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "scene/run_plan.h"
#include "sim/core/result.h"
#include "sim/simulation.h"
#include "sim/stepping/phase_times.h"

namespace shaken::run {

/// What a part of the run will cost.
struct Cost {
  std::int64_t count = 0;  ///< of samples, frames, ... in the whole run
  double each = 0;         ///< CPU time of one [s]
  double once = 0;         ///< CPU time besides [s]
  double cpu() const { return once + static_cast<double>(count) * each; }
};

/// Bytes that the finished run leaves on the disk.
struct DiskUse {
  double trajectory = 0;
  double observables = 0;
  double checkpoints = 0;  ///< the last two
  double total() const { return trajectory + observables + checkpoints; }
};

/// What a short piece of a run tells of the whole run on this machine, on one thread.
struct Probe {
  // the piece
  double warm_up = 0;    ///< simulated before timing [s]
  double simulated = 0;  ///< while timing [s]
  double cpu = 0;        ///< that this took [s]

  // the whole
  double run_ticks = 0;
  double tick_cpu = 0;                        ///< CPU time of a tick [s]
  std::array<double, kPhases> stages{};       ///< shares of the stepping, in the order of kPhaseNames
  std::map<std::string, double> impulse_cpu;  ///< by effect: CPU time of its part in the impulse law [s]
  Cost snapshots;                             ///< every rod evaluated, for samples and frames
  std::map<std::string, Cost> samples;        ///< by effect, "measure_order"
  Cost trajectory, stream, checkpoints;       ///< zero where they are off
  Cost movie;                                 ///< drawn by a process of its own
  std::string movie_trouble;                  ///< why the movie could not be timed, if so
  DiskUse disk;

  double stepping() const { return run_ticks * tick_cpu; }
  /// CPU time of the run with all that belongs to it [s].
  double total() const;
};

/// Goes on with `simulation`, of this plan's system, for about `cpu` seconds, and times once what the run does now and
/// then beside stepping. At tick 0 half of `cpu` goes by before anything is timed. Fails if the steps meet
/// numerical trouble or the disk refuses. Files go to a temporary folder.
Result<Probe> probe(const scene::RunPlan& plan, Simulation simulation, double cpu);

}  // namespace shaken::run
