#include <string>

#include "analysis/self_scattering.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

/// Curves of all waves one behind the other.
analysis::EstimateCurve row_by_row(const std::array<analysis::EstimateCurve, analysis::kScatteringWaves>& waves) {
  analysis::EstimateCurve rows;
  for (const analysis::EstimateCurve& wave : waves) {
    rows.value.insert(rows.value.end(), wave.value.begin(), wave.value.end());
    rows.sem.insert(rows.sem.end(), wave.sem.begin(), wave.sem.end());
  }
  return rows;
}

std::unique_ptr<Measurement> measure_scattering(const MeasureContext& context) {
  const double wavelength = context.plan.scattering->wavelength_for(context.plan.system.rod.length);
  const auto sample = [](const Sample& now, auto& scattering) {
    scattering.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [](Reduction& result, const auto& scattering) {
    const analysis::ScatteringCurve curve = scattering.reduce(result.t_steady);
    result.arrays["/scattering/q_per_mm"] = scattering.wave_numbers();
    result.arrays["/scattering/lag_s"] = curve.lag;
    put(result, "/scattering/f", "", row_by_row(curve.mean));
    put(result, "/scattering/f_along", "", row_by_row(curve.along));
    put(result, "/scattering/f_across", "", row_by_row(curve.across));
    put(result, "/scattering/alpha_2", "", curve.alpha_2);
    put(result, "/scattering/alpha_2_along", "", curve.alpha_2_along);
    put(result, "/scattering/alpha_2_across", "", curve.alpha_2_across);
    const analysis::ScatteringSummary summary = analysis::SelfScattering::summarize(curve);
    for (std::size_t wave = 0; wave < analysis::kScatteringWaves; ++wave) {
      result.scalars["relaxation_q" + std::to_string(wave + 1) + "_s"] = scalar(summary.relaxation[wave]);
    }
    result.scalars["alpha_2_peak"] = scalar(summary.alpha_2_peak);
    result.scalars["alpha_2_peak_lag_s"] = {{summary.alpha_2_peak_lag}};
  };
  return measured(sample, reduce, analysis::SelfScattering(context.interval, wavelength));
}

constexpr const char* kNotRelaxed = "F_s does not fall to 1/e within the lags measured";

}  // namespace

MeasurementKind scattering_kind() {
  return {
      .name = "scattering",
      .sources = "self_scattering, lags/lag_average",
      .make = measure_scattering,
      .only_steady = true,
      .arrays =
          {
              called("wave number", "q", {"q_per_mm", "(4) wave numbers q"}),
              called("lag", "t", {"lag_s", "(lags) lags"}),
              called("self-intermediate scattering", "F_s(q, t)",
                     {"f", "(4 · lags) F_s(q, t), row by row: the mean of both of the following", kWithError}),
              {"f_along", "(4 · lags) of q along the director", kWithError},
              {"f_across", "(4 · lags) of q across it", kWithError},
              called("non-Gaussian parameter", "α_2(t)",
                     {"alpha_2", "(lags) non-Gaussian parameter of displacements in the plane", kWithError}),
              {"alpha_2_along", "(lags) of those along the director", kWithError},
              {"alpha_2_across", "(lags) of those across it", kWithError},
          },
      .axes = {{"f", "q_per_mm lag_s"}, {"f_along", "q_per_mm lag_s"}, {"f_across", "q_per_mm lag_s"}, {"", "lag_s"}},
      .numbers =
          {
              {"relaxation_q1_s", "lag at which F_s falls to 1/e, of the first (smallest) wave number", false,
               kNotRelaxed},
              {"relaxation_q2_s", "of the second", false, kNotRelaxed},
              {"relaxation_q3_s", "of the third", false, kNotRelaxed},
              {"relaxation_q4_s", "of the fourth", false, kNotRelaxed},
              called("largest non-Gaussian parameter", R"(\hat{α}_2)",
                     {"alpha_2_peak", "largest α₂ of displacements in the plane"}),
              {"alpha_2_peak_lag_s", "lag at which it is largest"},
          },
      .of_axis = {"f_along", "f_across", "alpha_2_along", "alpha_2_across"},
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
