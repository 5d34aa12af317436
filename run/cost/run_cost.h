#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/core/result.h"
#include "scene/keys/run_plan.h"
#include "sim/simulation.h"

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
  /// Bytes of trajectory.part, which goes when trajectory.h5 is made of it; until then both need room.
  double trajectory_part = 0;
  double total() const { return trajectory + observables + checkpoints; }
  /// Bytes at the end of the run, before trajectory.part goes.
  double most() const { return total() + trajectory_part; }
};

/// What a run will cost on this machine, on one thread: ticks times the time of a tick, and the number of each thing
/// that the run does now and then times the time of one. The times are those of a short piece of the run, the probe.
struct RunCost {
  // the probe
  double warm_up = 0;    ///< simulated before timing [s]
  double simulated = 0;  ///< while timing [s]
  double cpu = 0;        ///< that this took [s]

  // the whole
  double run_ticks = 0;
  double tick_cpu = 0;  ///< CPU time of a tick [s]
  /// What is done now and then, by effect: "measure_order", "trajectory", "stream", "movie" (by a process of its own).
  std::map<std::string, Cost> parts;
  Cost checkpoints;
  std::string movie_trouble;  ///< why the movie could not be timed, if so
  DiskUse disk;
  double memory = 0;  ///< held at most, with the renderer of its movie and all that is measured [bytes]

  double stepping() const { return run_ticks * tick_cpu; }
  /// CPU time of the run with all that belongs to it [s].
  double total() const;
  /// CPU time of what is measured, recorded, sent or drawn [s]; none for the physics, which is stepping as a whole, and
  /// for a movie that could not be timed.
  std::optional<double> cpu_of(const std::string& effect) const;
};

/// Goes on with `simulation`, of this plan's system, for about `cpu` seconds, or a tenth of the time that the run will
/// take if that is less, and times once what the run does now and then beside stepping. At tick 0 half of `cpu` goes by
/// before anything is timed. Bytes of measurements follow from the plan (scene/keys/observables.h). Fails if the steps
/// meet numerical trouble or the disk refuses. Files go to a temporary folder.
Result<RunCost> cost_of_run(const scene::RunPlan& plan, Simulation simulation, double cpu);

/// What a plan calls for and, if it was probed, what that costs; what `shaken-worker --probe` writes:
///   {"effects": [{"name", "what", "on", "why", "cpu_share"?}],
///    "probe":  {"warm_up_s", "simulated_s", "cpu_s", "rod_seconds_per_cpu_second"},
///    "stepping_cpu_share", "checkpoints_cpu_share",
///    "cpu_seconds", "stepping_cpu_seconds", "disk_bytes": {"trajectory", "observables", "checkpoints", "total",
///    "most"}, "memory_bytes"}
/// "most" is what the disk must have room for at the end of the run, "total" what stays. All shares are of
/// "cpu_seconds", the CPU time of the whole run with its movie, and add up to 1. What is measured, recorded or drawn
/// has one of its own; the physics is stepping as a whole.
nlohmann::ordered_json cost_report(const scene::RunPlan& plan, const std::optional<RunCost>& cost);

}  // namespace shaken::run
