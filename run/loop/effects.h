#pragma once

#include <string>
#include <vector>

#include "run/loop/open_run.h"
#include "run/loop/summary.h"

namespace shaken::run {

/// One thing that a plan may call for: physics, measurement, recording, live state or movie.
struct EffectLine {
  std::string name;  ///< "rod_rod_friction", "measure_order", "trajectory"
  std::string what;  ///< one line
  bool on = false;
  std::string why;  ///< the key that decides, with its value
};

/// Every effect that there is, on or off in this plan.
std::vector<EffectLine> list_effects(const scene::RunPlan& plan);

/// The same by name, with the work that each did in this run. `n_live_frames`: none if no live state was sent.
std::map<std::string, EffectReport> report_effects(const scene::RunPlan& plan, const OpenRun& run,
                                                   std::optional<std::int64_t> n_live_frames);

}  // namespace shaken::run
