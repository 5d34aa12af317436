#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "client/live/json.h"
#include "scene/sweeps/sweep.h"

namespace shaken::client {

struct EstimateOptions {
  double cpu = 1.0;    ///< CPU time of the probe's steps, at most about [s]; 0: none, only what is on and off
  std::string from{};  ///< directory of a run of the same system to start from; empty: the run's own start
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
  double rod_seconds = 0;      ///< rods times simulated seconds, all runs together

  /// Rod-seconds per CPU-second, with all that is measured and drawn.
  double speed() const { return cpu > 0 ? rod_seconds / cpu : 0; }
};

/// What the run of one point costs with the step that its scene has, or those of several together.
struct PointCost {
  double stepping = 0;  ///< CPU time [s]
  double besides = 0;   ///< the same of measuring, recording, drawing [s]
  double disk = 0;      ///< that stays [bytes]
  double rod_seconds = 0;

  /// With a step that makes stepping so many times as long.
  double cpu(double factor = 1) const { return factor * stepping + besides; }
  PointCost& operator+=(const PointCost& other) {
    stepping += other.stepping;
    besides += other.besides;
    disk += other.disk;
    rod_seconds += other.rod_seconds;
    return *this;
  }
};

/// What a sweep would cost on this machine, on one core.
struct CostEstimate {
  std::size_t n_runs = 0;
  std::size_t shown = 0;  ///< the point that `report` is of
  Json report{};          ///< of `shaken-worker --probe` (run/cost/run_cost.h)
  std::vector<LevelCost> levels{};
  std::vector<PointCost> runs{};  ///< in the order of the sweep's points; empty if nothing was probed
};

/// Probes the point in the middle by `shaken-worker --probe`; the costs of the others follow from their numbers of
/// rods, times, steps and area fractions. Throws Failure if the point cannot be simulated.
CostEstimate estimate_cost(const scene::Sweep& sweep, const EstimateOptions& options);

/// The costs as a table, and a line on where they come from; empty if nothing was probed.
std::string estimate_text(const CostEstimate& estimate, int width);
Json estimate_json(const CostEstimate& estimate);

/// "12.3 CPU-hours", "4.1 CPU-minutes"
std::string cpu_text(double seconds);

}  // namespace shaken::client
