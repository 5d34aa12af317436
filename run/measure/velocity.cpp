#include <cmath>

#include "analysis/velocity_correlation.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::VelocityCurve;
using analysis::VelocitySummary;

Estimate root_mean_square(const VelocitySummary& summary) {
  Estimate root = summary.mean_square;
  root.value = std::sqrt(root.value);
  root.sem /= 2 * root.value;
  return root;
}

constexpr std::array kVelocityCurves{
    from<&VelocityCurve::lag>(called("lag", "t", {"lag_s", "lags"})),
    from<&VelocityCurve::c_v>(over(
        "window", called("velocity memory", "C_v(t)", {"c_v", "C_v(t), normalised to 1 at 0, of mean velocities"}))),
    from<&VelocityCurve::along>(over("window", called("velocity memory along", "C_v(t)",
                                                      of_axis({"c_v_along", "of the component along the director"})))),
    from<&VelocityCurve::across>(over("window", of_axis({"c_v_across", "of the component across it"}))),
    from<&VelocityCurve::product>(over("window", {"product_mm2_s2", "⟨v(t) · v(t + lag)⟩: C_v(t), not normalised"})),
    from<&VelocityCurve::product_along>(
        over("window", of_axis({"product_along_mm2_s2", "of the component along the director"}))),
    from<&VelocityCurve::product_across>(
        over("window", of_axis({"product_across_mm2_s2", "of the component across it"}))),
    from<&VelocityCurve::direction>(
        over("window", {"direction", "⟨u(t) · u(t + lag)⟩ of the unit vectors u of the velocities: persistence"})),
};
constexpr std::array kVelocityNumbers{
    from<&VelocitySummary::correlation_time>(
        over("window", {"velocity_correlation_s", "integral of C_v up to its first zero"})),
    from<&VelocitySummary::decay_time>(over("window", {"velocity_decay_s", "lag at which C_v falls to 1/e", false,
                                                       "C_v does not fall to 1/e within the lags measured"})),
    from<&VelocitySummary::mean_square_along>(
        over("window", of_axis({"velocity_variance_along_mm2_s2",
                                "⟨v²⟩ along the director of the mean velocities: C_v(0), not normalised"}))),
    from<&VelocitySummary::mean_square_across>(
        over("window", of_axis({"velocity_variance_across_mm2_s2", "⟨v²⟩ across it"}))),
    from<&VelocitySummary::persistence_time>(
        over("window", {"persistence_time_s", "for how long a rod keeps its direction"})),
    from<&VelocitySummary::persistence_length>(
        over("window", {"persistence_length_mm", "how far it gets in that direction"})),
    from<root_mean_square>(
        over("window", called("rms speed of displacements", "",
                              {"velocity_rms_mm_s",
                               "√⟨v²⟩ in the plane of the mean velocities; those of instants: `speed_rms_mm_s`"}))),
};

std::unique_ptr<Measurement> measure_velocity(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& velocity) {
    velocity.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [](Reduction& result, const auto& velocity) {
    put(result, "/velocity/", kVelocityCurves, velocity.reduce(result.t_steady));
    put(result, "", kVelocityNumbers, velocity.summarize(result.t_steady));
  };
  return measured(sample, reduce, analysis::VelocityCorrelation(context.interval, context.plan.velocity->window));
}

}  // namespace

MeasurementKind velocity_kind() {
  return {
      .name = "velocity",
      .sources = "velocity_correlation, lags/lag_average",
      .make = measure_velocity,
      .only_steady = true,
      .arrays = outputs_of(kVelocityCurves),
      .numbers = outputs_of(kVelocityNumbers),

      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
