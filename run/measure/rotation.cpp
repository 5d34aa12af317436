// SPDX-License-Identifier: MIT
#include "analysis/rotation.h"

#include <optional>

#include "analysis/steady.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredRotation : public Measurement {
 public:
  MeasuredRotation(double interval, std::optional<double> steady) : steady_(steady), rotation_(interval) {}

  void sample(const Sample& sample) override {
    if (!analysis::is_steady(sample->time, steady_.value_or(0.0))) return;
    rotation_.accumulate(sample->time, sample->director);
  }
  void reduce(Reduction& result) const override {
    const double from = steady_.value_or(result.t_steady);
    const analysis::RotationCurve curve = rotation_.reduce(from);
    result.arrays["/rotation/lag_s"] = curve.lag;
    put(result, "/rotation/msad", "_rad2", curve.msad);
    put(result, "/rotation/c2", "", curve.c2);
    const analysis::RotationSummary summary = rotation_.summarize(from);
    result.scalars["rotational_diffusion_rad2_s"] = scalar(summary.d_r);
    result.scalars["alpha_rotation_short"] = scalar(summary.growth.at_short.exponent);
    result.scalars["alpha_rotation_long"] = scalar(summary.growth.at_long.exponent);
    result.scalars["c2_plateau"] = scalar(summary.c2_plateau);
    result.scalars["c2_decay_s"] = scalar(summary.c2_decay_time);
    result.scalars["large_turns"] = {{summary.large_turns}};
    result.scalars["rotation_lag_from_s"] = {{summary.growth.at_long.lag_from}};
    result.scalars["rotation_lag_to_s"] = {{summary.growth.at_long.lag_to}};
    result.scalars["rotation_short_lag_from_s"] = {{summary.growth.at_short.lag_from}};
    result.scalars["rotation_short_lag_to_s"] = {{summary.growth.at_short.lag_to}};
  }
  void save(StateWriter& writer) const override { rotation_.save(writer); }
  void restore(StateReader& reader) override { rotation_.restore(reader); }

 private:
  std::optional<double> steady_;  ///< [s]; given, it leaves out what is before, or else the reduction does
  analysis::Rotation rotation_;
};

}  // namespace

MeasurementKind rotation_kind() {
  return {
      .name = "rotation",
      .sources = "rotation, lag_fits, lag_average",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredRotation>(context.interval, context.plan.steady);
      },
      .arrays =
          {
              {"lag_s", "lags"},
              {"msad_rad2", "mean square angular displacement", kWithError},
              {"c2", "C₂(t) = ⟨cos 2Δθ⟩", kWithError},
          },
      .numbers =
          {
              {"rotational_diffusion_rad2_s",
               "D_r at long lags, from `rotation_lag_from_s` to `rotation_lag_to_s`: half the slope of the MSAD"},
              {"alpha_rotation_short",
               "exponent of the MSAD at short lags, from `rotation_short_lag_from_s` to `rotation_short_lag_to_s`"},
              {"alpha_rotation_long", "exponent at long lags"},
              {"c2_plateau", "mean of C₂ over the last octave of lags"},
              {"c2_decay_s", "lag at which C₂ falls to 1/e; null if it does not", false,
               "C2 does not fall to 1/e within the lags measured"},
              over("every", {"large_turns",
                             "turns by more than π/3 from one sample to the next: should be 0, or that is too long"}),
              {"rotation_lag_from_s", "shortest of the long lags"},
              {"rotation_lag_to_s", "longest of the long lags"},
              {"rotation_short_lag_from_s", "shortest of the short lags"},
              {"rotation_short_lag_to_s", "longest of the short lags"},
          },
  };
}

}  // namespace shaken::run
