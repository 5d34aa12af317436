#include <string>

#include "analysis/self_scattering.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::ScatteringCurve;
using analysis::ScatteringSummary;

/// Curves of all waves one behind the other.
analysis::EstimateCurve row_by_row(const std::array<analysis::EstimateCurve, analysis::kScatteringWaves>& waves) {
  analysis::EstimateCurve rows;
  for (const analysis::EstimateCurve& wave : waves) {
    rows.value.insert(rows.value.end(), wave.value.begin(), wave.value.end());
    rows.sem.insert(rows.sem.end(), wave.sem.begin(), wave.sem.end());
  }
  return rows;
}
template <std::size_t kWave>
Estimate relaxation(const ScatteringSummary& summary) {
  return summary.relaxation[kWave];
}

constexpr const char* kNotRelaxed = "F_s does not fall to 1/e within the lags measured";
constexpr std::array kScatteringWaves{
    from<&analysis::SelfScattering::wave_numbers>(called("wave number", "q", {"q_per_mm", "(4) wave numbers q"})),
};
constexpr std::array kScatteringCurves{
    from<&ScatteringCurve::lag>(called("lag", "t", {"lag_s", "(lags) lags"})),
    from<[](const ScatteringCurve& curve) { return row_by_row(curve.mean); }>(
        called("self-intermediate scattering", "F_s(q, t)",
               {"f", "(4 · lags) F_s(q, t), row by row: the mean of both of the following"})),
    from<[](const ScatteringCurve& curve) { return row_by_row(curve.along); }>(
        of_axis({"f_along", "(4 · lags) of q along the director"})),
    from<[](const ScatteringCurve& curve) { return row_by_row(curve.across); }>(
        of_axis({"f_across", "(4 · lags) of q across it"})),
    from<&ScatteringCurve::alpha_2>(called("non-Gaussian parameter", "α_2(t)",
                                           {"alpha_2", "(lags) non-Gaussian parameter of displacements in the plane"})),
    from<&ScatteringCurve::alpha_2_along>(of_axis({"alpha_2_along", "(lags) of those along the director"})),
    from<&ScatteringCurve::alpha_2_across>(of_axis({"alpha_2_across", "(lags) of those across it"})),
};
constexpr std::array kScatteringNumbers{
    from<relaxation<0>>(
        {"relaxation_q1_s", "lag at which F_s falls to 1/e, of the first (smallest) wave number", false, kNotRelaxed}),
    from<relaxation<1>>({"relaxation_q2_s", "of the second", false, kNotRelaxed}),
    from<relaxation<2>>({"relaxation_q3_s", "of the third", false, kNotRelaxed}),
    from<relaxation<3>>({"relaxation_q4_s", "of the fourth", false, kNotRelaxed}),
    from<&ScatteringSummary::alpha_2_peak>(called("largest non-Gaussian parameter", R"(\hat{α}_2)",
                                                  {"alpha_2_peak", "largest α₂ of displacements in the plane"})),
    from<&ScatteringSummary::alpha_2_peak_lag>({"alpha_2_peak_lag_s", "lag at which it is largest"}),
};

std::unique_ptr<Measurement> measure_scattering(const MeasureContext& context) {
  const double wavelength = context.plan.scattering->wavelength_for(context.plan.system.rod.length);
  const auto sample = [](const Sample& now, auto& scattering) {
    scattering.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [](Reduction& result, const auto& scattering) {
    const ScatteringCurve curve = scattering.reduce(result.t_steady);
    put(result, "/scattering/", kScatteringWaves, scattering);
    put(result, "/scattering/", kScatteringCurves, curve);
    put(result, "", kScatteringNumbers, analysis::SelfScattering::summarize(curve));
  };
  return measured(sample, reduce, analysis::SelfScattering(context.interval, wavelength));
}

}  // namespace

MeasurementKind scattering_kind() {
  return {
      .name = "scattering",
      .sources = "self_scattering, lags/lag_average",
      .make = measure_scattering,
      .only_steady = true,
      .arrays = outputs_of(kScatteringWaves, kScatteringCurves),
      .axes = {{"f", "q_per_mm lag_s"}, {"f_along", "q_per_mm lag_s"}, {"f_across", "q_per_mm lag_s"}, {"", "lag_s"}},
      .numbers = outputs_of(kScatteringNumbers),

      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
