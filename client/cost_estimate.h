// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/console.h"
#include "client/live/json.h"
#include "scene/sweep.h"

namespace shaken::client {

/// Shows how many probes of a run are made, with nothing left of it at the end.
using ProbeProgress = std::function<void(std::size_t done, std::size_t all)>;
/// A line on a terminal's stderr, redrawn. Where stderr is no terminal, a line now and then if `in_logs`: not beside
/// JSON, which scripts may read together with stderr.
ProbeProgress probe_progress(const Console& console, bool in_logs);

/// At most this many of a sweep's points are probed.
inline constexpr std::size_t kMostProbes = 5;

struct EstimateOptions {
  bool probe = true;   ///< step a piece of some runs; otherwise only what is on and off
  double cpu = 1.5;    ///< CPU time of all probes' steps together, at most about [s]
  std::string from{};  ///< directory of a run of the same system to start from; empty: the run's own start
  std::size_t most_probes = kMostProbes;  ///< points of a sweep that are probed, at most
  ProbeProgress on_probe{};               ///< called before the first probe and after each
};

/// What a level of accuracy sets.
struct Ticks {
  double step = 0;  ///< [s]
  ImpactTime impacts = ImpactTime::kTickEnd;
};

/// What all runs of a sweep cost together at one step.
struct LevelCost {
  std::string name;            ///< of the level of accuracy; "as written" for the steps of the scenes themselves
  std::optional<Ticks> ticks;  ///< none where the scenes have several
  double cpu = 0;              ///< [s], all runs together
  double disk = 0;             ///< [bytes]
};

/// What one run costs with the step that its scene has.
struct RunCost {
  double cpu = 0;     ///< [s]
  double disk = 0;    ///< that stays [bytes]
  double most = 0;    ///< that the disk must have room for at its end [bytes]
  double memory = 0;  ///< held at most: what a short piece of it takes, and what its measurements may grow to [bytes]
};

/// What a sweep would cost on this machine, on one core.
struct CostEstimate {
  std::size_t n_runs = 0;
  std::size_t n_distinct = 0;  ///< runs that differ in more than their seed
  std::size_t n_probed = 0;    ///< of these
  std::size_t shown = 0;       ///< the point that `report` is of
  Json report;                 ///< of `shaken-worker --probe` (run/probe/probe.h)
  std::vector<LevelCost> levels;
  std::vector<RunCost> runs;  ///< (n_runs) in the order of the sweep's points; empty if nothing was probed
};

/// Probes a handful of points by `shaken-worker --probe`, evenly along the sweep; costs of those between them, per rod
/// and simulated second, are interpolated. Another level of accuracy is taken to change the cost of stepping by the
/// factor that was measured for it (scene/accuracy_levels.h). Throws Failure if a point cannot be simulated.
CostEstimate estimate_cost(const scene::Sweep& sweep, const EstimateOptions& options);

/// The costs as a table, and a line on where they come from; empty if nothing was probed.
std::string estimate_text(const CostEstimate& estimate, int width);
Json estimate_json(const CostEstimate& estimate);

/// "12.3 CPU-hours", "4.1 CPU-minutes"
std::string cpu_text(double seconds);

}  // namespace shaken::client
