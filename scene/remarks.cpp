// SPDX-License-Identifier: MIT
#include "scene/remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/keys/units.h"
#include "scene/derived.h"
#include "scene/fields.h"
#include "scene/measured_species.h"
#include "scene/observables.h"

namespace shaken::scene {

namespace {

bool moves(const System& system) { return system.amplitude > 0 && (system.base || system.lid); }

/// At how many phases of a vibration samples are taken that follow each other after so many periods; 0: at many.
int phases_met(double periods) {
  constexpr int kMany = 24;
  for (int n = 1; n <= kMany; ++n) {
    if (std::abs(n * periods - std::round(n * periods)) < 1e-6 * n * std::max(1.0, periods)) return n;
  }
  return 0;
}

/// The blocks that ask for what spheres do not have, "measure.order, measure.defects"; empty if there are none.
std::string of_axes_that_are_missing(const RunPlan& plan) {
  std::string blocks;
  for (const Observable& observable : observables()) {
    if (!observable.lacks_axis(plan)) continue;
    blocks += (blocks.empty() ? "" : ", ") + observable.block.path;
  }
  return blocks;
}

}  // namespace

std::vector<std::string> remarks(const RunPlan& plan) {
  std::vector<std::string> list;
  const double total = plan.total_time();
  const auto remark_one_frame = [&](const char* path, double every) {
    if (every <= total) return;
    list.push_back(fmt::format("{} {} is longer than the run, {}: there will be a single frame, of the start", path,
                               format_quantity(every, Dimension::kTime), format_quantity(total, Dimension::kTime)));
  };
  if (plan.tilt && plan.tilt->phases == SamplePhases::kLocked && moves(plan.system)) {
    const double periods = plan.tilt->every * plan.system.frequency;
    if (const int phases = phases_met(periods); phases > 0) {
      list.push_back(fmt::format(
          "measure.tilt.every {} is {:.6g} periods of the plates: samples see them at {} of their vibration, and mean "
          "velocities may be those of that instant; take measure.tilt.phases \"spread\"",
          format_quantity(plan.tilt->every, Dimension::kTime), periods,
          phases == 1 ? "a single phase" : fmt::format("{} phases", phases)));
    }
  }
  if (plan.trajectory) remark_one_frame("trajectory.every", plan.trajectory->every);
  if (plan.movie) remark_one_frame("movie.every", plan.movie->every);
  for (const Field& field : fields()) {
    const Field* block = fields().block_of(field);
    if (block == nullptr || !block->path.starts_with("measure.") || field.path != block->path + ".every" ||
        !std::get<bool>(block->fetch(plan)) || std::get<double>(field.fetch(plan)) <= total) {
      continue;
    }
    list.push_back(fmt::format("{} {} is longer than the run, {}: there will be a single sample, of the start",
                               field.path, format_quantity(std::get<double>(field.fetch(plan)), Dimension::kTime),
                               format_quantity(total, Dimension::kTime)));
  }
  const bool is_of_one_of_several =
      plan.of == MeasuredSpecies::kFirst && (plan.system.added[0] || plan.system.added[1]);
  for (const MeasuredRods& rods : measured_species(plan)) {
    const std::string unmeasured = of_axes_that_are_missing(rods.plan);
    if (unmeasured.empty()) continue;
    list.push_back(fmt::format(
        "spheres ({}.beads 1) have no axis, so this is not measured: {}{}", rods.prefix.empty() ? "rods" : rods.prefix,
        unmeasured, is_of_one_of_several ? "; observables are those of the first species (measure.of)" : ""));
  }
  const auto gamma = gamma_of(plan.system);
  if (gamma && *gamma < 1 && plan.system.base) {
    list.push_back(
        fmt::format("plates.gamma is {:.4g}: below 1 the base never falls faster than the rods, which come "
                    "to rest on it",
                    *gamma));
  }
  return list;
}

}  // namespace shaken::scene
