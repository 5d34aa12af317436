#include "analysis/rotation.h"

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::RotationCurve;
using analysis::RotationSummary;

constexpr std::array kRotationCurves{
    from<&RotationCurve::lag>(called("lag", "t", {"lag_s", "lags"})),
    from<&RotationCurve::msad>(
        called("mean square angular displacement", "", {"msad_rad2", "mean square angular displacement"})),
    from<&RotationCurve::c2>(called("orientational memory", "C_2(t)", {"c2", "C₂(t) = ⟨cos 2Δθ⟩"})),
};
constexpr std::array kRotationNumbers{
    from<&RotationSummary::d_r>(
        called("rotational diffusion", R"(D_\mathrm{r})",
               {"rotational_diffusion_rad2_s",
                "D_r at long lags, from `rotation_lag_from_s` to `rotation_lag_to_s`: half the slope of the MSAD"})),
    from<[](const RotationSummary& found) { return found.growth.at_short.exponent; }>(
        {"alpha_rotation_short",
         "exponent of the MSAD at short lags, from `rotation_short_lag_from_s` to `rotation_short_lag_to_s`"}),
    from<[](const RotationSummary& found) { return found.growth.at_long.exponent; }>(
        {"alpha_rotation_long", "exponent at long lags"}),
    from<&RotationSummary::c2_plateau>(
        called("plateau of the memory", "C_2", {"c2_plateau", "mean of C₂ over the last octave of lags"})),
    from<&RotationSummary::c2_decay_time>(called("memory $C_2$ to 1/e", "",
                                                 {"c2_decay_s", "lag at which C₂ falls to 1/e; null if it does not",
                                                  false, "C2 does not fall to 1/e within the lags measured"})),
    from<&RotationSummary::large_turns>(
        over("every",
             {"large_turns", "turns by more than π/3 from one sample to the next: should be 0, or that is too long"})),
    from<[](const RotationSummary& found) { return found.growth.at_long.lag_from; }>(
        {"rotation_lag_from_s", "shortest of the long lags"}),
    from<[](const RotationSummary& found) { return found.growth.at_long.lag_to; }>(
        {"rotation_lag_to_s", "longest of the long lags"}),
    from<[](const RotationSummary& found) { return found.growth.at_short.lag_from; }>(
        {"rotation_short_lag_from_s", "shortest of the short lags"}),
    from<[](const RotationSummary& found) { return found.growth.at_short.lag_to; }>(
        {"rotation_short_lag_to_s", "longest of the short lags"}),
};

std::unique_ptr<Measurement> measure_rotation(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& rotation) {
    rotation.accumulate(now->time, now->by_track(now->director));
  };
  const auto reduce = [](Reduction& result, const auto& rotation) {
    put(result, "/rotation/", kRotationCurves, rotation.reduce(result.t_steady));
    put(result, "", kRotationNumbers, rotation.summarize(result.t_steady));
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
      .arrays = outputs_of(kRotationCurves),
      .numbers = outputs_of(kRotationNumbers),
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
