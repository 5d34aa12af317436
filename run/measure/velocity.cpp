#include <cmath>

#include "analysis/velocity_correlation.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_velocity(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& velocity) {
    velocity.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [](Reduction& result, const auto& velocity) {
    const analysis::VelocityCurve curve = velocity.reduce(result.t_steady);
    result.arrays["/velocity/lag_s"] = curve.lag;
    put(result, "/velocity/c_v", "", curve.c_v);
    put(result, "/velocity/c_v_along", "", curve.along);
    put(result, "/velocity/c_v_across", "", curve.across);
    put(result, "/velocity/product", "_mm2_s2", curve.product);
    put(result, "/velocity/product_along", "_mm2_s2", curve.product_along);
    put(result, "/velocity/product_across", "_mm2_s2", curve.product_across);
    put(result, "/velocity/direction", "", curve.direction);
    const analysis::VelocitySummary summary = velocity.summarize(result.t_steady);
    result.scalars["velocity_correlation_s"] = scalar(summary.correlation_time);
    result.scalars["velocity_decay_s"] = scalar(summary.decay_time);
    result.scalars["velocity_variance_along_mm2_s2"] = scalar(summary.mean_square_along);
    result.scalars["velocity_variance_across_mm2_s2"] = scalar(summary.mean_square_across);
    result.scalars["persistence_time_s"] = scalar(summary.persistence_time);
    result.scalars["persistence_length_mm"] = scalar(summary.persistence_length);
    const double rms = std::sqrt(summary.mean_square.value);
    Scalar& velocity_rms = result.scalars["velocity_rms_mm_s"] = scalar(summary.mean_square);
    velocity_rms.value = rms;
    velocity_rms.sem /= 2 * rms;
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
      .arrays =
          {
              called("lag", "t", {"lag_s", "lags"}),
              over("window", called("velocity memory", "C_v(t)",
                                    {"c_v", "C_v(t), normalised to 1 at 0, of mean velocities", kWithError})),
              over("window", called("velocity memory along", "C_v(t)",
                                    {"c_v_along", "of the component along the director", kWithError})),
              over("window", {"c_v_across", "of the component across it", kWithError}),
              over("window", {"product_mm2_s2", "⟨v(t) · v(t + lag)⟩: C_v(t), not normalised", kWithError}),
              over("window", {"product_along_mm2_s2", "of the component along the director", kWithError}),
              over("window", {"product_across_mm2_s2", "of the component across it", kWithError}),
              over("window", {"direction", "⟨u(t) · u(t + lag)⟩ of the unit vectors u of the velocities: persistence",
                              kWithError}),
          },
      .numbers =
          {
              over("window", {"velocity_correlation_s", "integral of C_v up to its first zero"}),
              over("window", {"velocity_decay_s", "lag at which C_v falls to 1/e", false,
                              "C_v does not fall to 1/e within the lags measured"}),
              over("window", {"velocity_variance_along_mm2_s2",
                              "⟨v²⟩ along the director of the mean velocities: C_v(0), not normalised"}),
              over("window", {"velocity_variance_across_mm2_s2", "⟨v²⟩ across it"}),
              over("window", {"persistence_time_s", "for how long a rod keeps its direction"}),
              over("window", {"persistence_length_mm", "how far it gets in that direction"}),
              over("window",
                   called("rms speed of displacements", "",
                          {"velocity_rms_mm_s",
                           "√⟨v²⟩ in the plane of the mean velocities; those of instants: `speed_rms_mm_s`"})),
          },
      .of_axis = {"c_v_along", "c_v_across", "product_along_mm2_s2", "product_across_mm2_s2",
                  "velocity_variance_along_mm2_s2", "velocity_variance_across_mm2_s2"},
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
