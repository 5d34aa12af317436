// SPDX-License-Identifier: MIT
#include "run/measure/measurement_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/fields.h"
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

std::string MeasurementKind::meaning(const Output& output) const {
  if (output.over.empty()) return std::string(output.meaning);
  return fmt::format("{}; over {}`measure.{}.{}`", output.meaning,
                     output.times > 1 ? fmt::format("{} × ", output.times) : "", name, output.over);
}

double MeasurementKind::time_over(const Output& output, const scene::RunPlan& plan, double interval) const {
  if (output.over.empty()) return std::numeric_limits<double>::quiet_NaN();
  const scene::Field& key = scene::field_at(fmt::format("measure.{}.{}", name, output.over));
  return output.times * std::max(1.0, std::round(std::get<double>(key.fetch(plan)) / interval)) * interval;
}

scene::RunPlan only(scene::RunPlan plan, const MeasurementKind& kind) {
  plan.steady = 0;
  for (const scene::Observable& other : scene::observables()) {
    if (other.name != kind.name) other.switch_off(plan);
  }
  return plan;
}

}  // namespace shaken::run
