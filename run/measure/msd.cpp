#include "analysis/msd.h"

#include <cmath>

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::MsdCurve;
struct MsdNumbers : analysis::Diffusion {
  int n_rods;
};

Scalar read_off(const analysis::Estimate& estimate, const analysis::GrowthFit& fit) {
  return scalar_or(estimate, std::isnan(fit.lag_from) ? "the run is too short: too few lags fit five times into it"
                                                      : "nothing moves");
}
Scalar exponent(const analysis::GrowthFit& fit) { return read_off(fit.exponent, fit); }
Scalar without_drift(const MsdNumbers& found) {
  if (found.n_rods == 1) return {{}, "a single rod has no motion but that of all"};
  return read_off(found.d_relative, found.relative.at_long);
}

constexpr std::array kMsdCurves{
    from<&MsdCurve::lag>(called("lag", "t", {"lag_s", "lags"})),
    from<&MsdCurve::total>(
        called("mean square displacement", R"(\mathrm{MSD})", {"total_mm2", "mean square displacement in the plane"})),
    from<&MsdCurve::along>(called("MSD along the director", "", of_axis({"along_mm2", "along the director"}))),
    from<&MsdCurve::across>(called("MSD across the director", "", of_axis({"across_mm2", "across the director"}))),
    from<&MsdCurve::relative_total>(
        {"relative_total_mm2", "in the plane, without the common drift of all N rods, times N/(N − 1)"}),
    from<&MsdCurve::relative_along>(of_axis({"relative_along_mm2", "along the director, without that drift"})),
    from<&MsdCurve::relative_across>(of_axis({"relative_across_mm2", "across the director, without that drift"})),
    from<&MsdCurve::d_total>({"d_total_mm2_s", "MSD / (4 lag)"}),
    from<&MsdCurve::d_along>(of_axis({"d_along_mm2_s", "MSD / (2 lag) of the displacement along the director"})),
    from<&MsdCurve::d_across>(of_axis({"d_across_mm2_s", "MSD / (2 lag) of the displacement across it"})),
    from<&MsdCurve::exponent>({"exponent", "d ln(total) / d ln(lag)"}),
};
constexpr std::array kMsdNumbers{
    from<[](const MsdNumbers& found) { return read_off(found.d_long, found.total.at_long); }>(
        called("diffusion coefficient", "D",
               {"diffusion_mm2_s",
                "D at long lags, from `diffusion_lag_from_s` to `diffusion_lag_to_s`: a quarter of the slope of the "
                "MSD"})),
    from<[](const MsdNumbers& found) { return read_off(found.d_short, found.total.at_short); }>(
        {"diffusion_short_mm2_s",
         "the same at short lags, from `diffusion_short_lag_from_s` to `diffusion_short_lag_to_s`"}),
    from<[](const MsdNumbers& found) { return read_off(found.d_along, found.along.at_long); }>(
        of_axis({"diffusion_along_mm2_s", "D along the director, at long lags"})),
    from<[](const MsdNumbers& found) { return read_off(found.d_across, found.across.at_long); }>(
        of_axis({"diffusion_across_mm2_s", "D across it"})),
    from<without_drift>({"diffusion_relative_mm2_s", "D without the common drift of all rods, at long lags"}),
    from<[](const MsdNumbers& found) { return exponent(found.total.at_short); }>(
        {"alpha_short", "exponent of the MSD at short lags"}),
    from<[](const MsdNumbers& found) { return exponent(found.total.at_long); }>(
        {"alpha_long", "exponent at long lags"}),
    from<[](const MsdNumbers& found) { return exponent(found.along.at_short); }>(
        of_axis({"alpha_along_short", "exponent of the displacement along the director, at short lags of its own"})),
    from<[](const MsdNumbers& found) { return exponent(found.along.at_long); }>(
        of_axis({"alpha_along_long", "the same at long lags"})),
    from<[](const MsdNumbers& found) { return exponent(found.across.at_short); }>(
        of_axis({"alpha_across_short", "exponent of the displacement across the director, at short lags of its own"})),
    from<[](const MsdNumbers& found) { return exponent(found.across.at_long); }>(
        of_axis({"alpha_across_long", "the same at long lags"})),
    from<[](const MsdNumbers& found) { return found.total.at_long.lag_from; }>(
        {"diffusion_lag_from_s", "shortest of the long lags"}),
    from<[](const MsdNumbers& found) { return found.total.at_long.lag_to; }>(
        {"diffusion_lag_to_s", "longest of the long lags"}),
    from<[](const MsdNumbers& found) { return found.total.at_short.lag_from; }>(
        {"diffusion_short_lag_from_s", "shortest of the short lags"}),
    from<[](const MsdNumbers& found) { return found.total.at_short.lag_to; }>(
        {"diffusion_short_lag_to_s", "longest of the short lags"}),
};

std::unique_ptr<Measurement> measure_msd(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& msd) {
    msd.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [n_rods = context.plan.system.n_rods](Reduction& result, const auto& msd) {
    put(result, "/msd/", kMsdCurves, msd.reduce(result.t_steady));
    put(result, "", kMsdNumbers, MsdNumbers{msd.diffusion(result.t_steady), n_rods});
  };
  return measured(
      sample, reduce,
      analysis::MeanSquareDisplacement(context.interval, static_cast<std::size_t>(context.plan.system.n_rods)));
}

}  // namespace

MeasurementKind msd_kind() {
  return {
      .name = "msd",
      .sources = "msd, lags/lag_fits, lags/lag_average",
      .make = measure_msd,
      .only_steady = true,
      .arrays = outputs_of(kMsdCurves),
      .numbers = outputs_of(kMsdNumbers),

      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
