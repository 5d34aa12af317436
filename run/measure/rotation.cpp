#include "analysis/rotation.h"

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_rotation(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& rotation) { rotation.accumulate(now->time, now->director); };
  const auto reduce = [](Reduction& result, const auto& rotation) {
    const analysis::RotationCurve curve = rotation.reduce(result.t_steady);
    result.arrays["/rotation/lag_s"] = curve.lag;
    put(result, "/rotation/msad", "_rad2", curve.msad);
    put(result, "/rotation/c2", "", curve.c2);
    const analysis::RotationSummary summary = rotation.summarize(result.t_steady);
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
  };
  return measured(sample, reduce, analysis::Rotation(context.interval));
}

}  // namespace

MeasurementKind rotation_kind() {
  return {
      .name = "rotation",
      .sources = "rotation, lags/lag_fits, lags/lag_average",
      .make = measure_rotation,
      .only_steady = true,
      .arrays =
          {
              called("lag", "t", {"lag_s", "lags"}),
              called("mean square angular displacement", "",
                     {"msad_rad2", "mean square angular displacement", kWithError}),
              called("orientational memory", "C_2(t)", {"c2", "C₂(t) = ⟨cos 2Δθ⟩", kWithError}),
          },
      .numbers =
          {
              called(
                  "rotational diffusion", R"(D_\mathrm{r})",
                  {"rotational_diffusion_rad2_s",
                   "D_r at long lags, from `rotation_lag_from_s` to `rotation_lag_to_s`: half the slope of the MSAD"}),
              {"alpha_rotation_short",
               "exponent of the MSAD at short lags, from `rotation_short_lag_from_s` to `rotation_short_lag_to_s`"},
              {"alpha_rotation_long", "exponent at long lags"},
              called("plateau of the memory", "C_2", {"c2_plateau", "mean of C₂ over the last octave of lags"}),
              called("memory $C_2$ to 1/e", "",
                     {"c2_decay_s", "lag at which C₂ falls to 1/e; null if it does not", false,
                      "C2 does not fall to 1/e within the lags measured"}),
              over("every", {"large_turns",
                             "turns by more than π/3 from one sample to the next: should be 0, or that is too long"}),
              {"rotation_lag_from_s", "shortest of the long lags"},
              {"rotation_lag_to_s", "longest of the long lags"},
              {"rotation_short_lag_from_s", "shortest of the short lags"},
              {"rotation_short_lag_to_s", "longest of the short lags"},
          },
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
