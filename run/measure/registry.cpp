// SPDX-License-Identifier: MIT
#include "run/measure/registry.h"

#include <cmath>

#include "analysis/bounded_series.h"

namespace shaken::run {
namespace {

using scene::RunPlan;

/// A kind whose settings are the optional block `member` of the plan.
template <auto member>
constexpr MeasurementKind kind(std::string_view name, std::unique_ptr<Measurement> (*make)(const MeasureContext&),
                               Growth growth = Growth::kBlocks,
                               std::int64_t (*kept)(const RunPlan&, std::int64_t) = nullptr) {
  return {name,
          [](const RunPlan& plan) { return plan.*member ? std::optional((plan.*member)->every) : std::nullopt; },
          [](RunPlan& plan) { (plan.*member).reset(); },
          make,
          growth,
          kept};
}

std::int64_t points_of(std::int64_t samples) { return analysis::BoundedSeries<2>::points_of(samples); }

/// Every defect found, if that is asked for, or their numbers only.
std::int64_t kept_of_defects(const RunPlan& plan, std::int64_t samples) {
  return plan.defects->list ? samples : points_of(samples);
}

std::int64_t kept_of_rods(const RunPlan& plan, std::int64_t samples) {
  const double most = std::floor(plan.rods->duration / plan.rods->every * (1 + 1e-12)) + 1;
  return most < static_cast<double>(samples) ? static_cast<std::int64_t>(most) : samples;
}

constexpr MeasurementKind kKinds[] = {
    kind<&RunPlan::order>("order", make_order, Growth::kSeries,
                          [](const RunPlan&, std::int64_t samples) { return points_of(samples); }),
    kind<&RunPlan::angles>("angles", make_angles),
    kind<&RunPlan::tilt>("tilt", make_tilt),
    kind<&RunPlan::defects>("defects", make_defects, Growth::kSeries, kept_of_defects),
    kind<&RunPlan::g2>("g2", make_g2),
    kind<&RunPlan::msd>("msd", make_msd, Growth::kLags),
    kind<&RunPlan::rotation>("rotation", make_rotation, Growth::kLags),
    kind<&RunPlan::velocity>("velocity", make_velocity, Growth::kLags),
    kind<&RunPlan::rods>("rods", make_rods, Growth::kSeries, kept_of_rods),
    kind<&RunPlan::fluctuations>("fluctuations", make_fluctuations),
    kind<&RunPlan::frank>("frank", make_frank),
    kind<&RunPlan::pairs>("pairs", make_pairs),
    kind<&RunPlan::layers>("layers", make_layers),
    kind<&RunPlan::lattice>("lattice", make_lattice),
};

}  // namespace

std::span<const MeasurementKind> measurement_kinds() { return kKinds; }

RunPlan only(RunPlan plan, const MeasurementKind& kind) {
  plan.steady = 0;
  for (const MeasurementKind& other : kKinds) {
    if (other.name != kind.name) other.switch_off(plan);
  }
  return plan;
}

}  // namespace shaken::run
