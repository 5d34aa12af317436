// SPDX-License-Identifier: MIT
#include "run/measure/measurement_kinds.h"

#include "scene/observables.h"

namespace shaken::run {

std::span<const MeasurementKind> measurement_kinds() {
#define SHAKEN_KIND(name, Settings) name##_kind(),
  static const std::vector<MeasurementKind> kinds{SHAKEN_OBSERVABLES(SHAKEN_KIND)};
#undef SHAKEN_KIND
  return kinds;
}

std::optional<double> MeasurementKind::every(const scene::RunPlan& plan) const {
  return scene::observable(name).period(plan);
}

std::optional<Cadence> MeasurementKind::cadence(const scene::RunPlan& plan) const {
  const std::optional<double> period = every(plan);
  if (!period) return std::nullopt;
  const System& system = plan.system;
  if (is_spread != nullptr && is_spread(plan)) return Cadence::spread(*period, system.dt, system.seed);
  return Cadence(*period, system.dt);
}

scene::RunPlan only(scene::RunPlan plan, const MeasurementKind& kind) {
  plan.steady = 0;
  for (const scene::Observable& other : scene::observables()) {
    if (other.name != kind.name) other.switch_off(plan);
  }
  return plan;
}

}  // namespace shaken::run
