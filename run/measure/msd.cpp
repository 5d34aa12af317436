#include "analysis/msd.h"

#include <cmath>

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

Scalar read_off(const analysis::Estimate& estimate, const analysis::GrowthFit& fit) {
  return scalar_or(estimate, std::isnan(fit.lag_from) ? "the run is too short: too few lags fit five times into it"
                                                      : "nothing moves");
}

std::unique_ptr<Measurement> measure_msd(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& msd) {
    msd.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [n_rods = context.plan.system.n_rods](Reduction& result, const auto& msd) {
    const analysis::MsdCurve curve = msd.reduce(result.t_steady);
    result.arrays["/msd/lag_s"] = curve.lag;
    put(result, "/msd/total", "_mm2", curve.total);
    put(result, "/msd/along", "_mm2", curve.along);
    put(result, "/msd/across", "_mm2", curve.across);
    put(result, "/msd/relative_total", "_mm2", curve.relative_total);
    put(result, "/msd/relative_along", "_mm2", curve.relative_along);
    put(result, "/msd/relative_across", "_mm2", curve.relative_across);
    put(result, "/msd/exponent", "", curve.exponent);
    put(result, "/msd/d_total", "_mm2_s", curve.d_total);
    put(result, "/msd/d_along", "_mm2_s", curve.d_along);
    put(result, "/msd/d_across", "_mm2_s", curve.d_across);
    const analysis::Diffusion diffusion = msd.diffusion(result.t_steady);
    const analysis::ShortAndLong &total = diffusion.total, &along = diffusion.along, &across = diffusion.across;
    result.scalars["diffusion_mm2_s"] = read_off(diffusion.d_long, total.at_long);
    result.scalars["diffusion_short_mm2_s"] = read_off(diffusion.d_short, total.at_short);
    result.scalars["diffusion_along_mm2_s"] = read_off(diffusion.d_along, along.at_long);
    result.scalars["diffusion_across_mm2_s"] = read_off(diffusion.d_across, across.at_long);
    result.scalars["diffusion_relative_mm2_s"] = n_rods > 1 ? read_off(diffusion.d_relative, diffusion.relative.at_long)
                                                            : Scalar{{}, "a single rod has no motion but that of all"};
    result.scalars["alpha_short"] = read_off(total.at_short.exponent, total.at_short);
    result.scalars["alpha_long"] = read_off(total.at_long.exponent, total.at_long);
    result.scalars["alpha_along_short"] = read_off(along.at_short.exponent, along.at_short);
    result.scalars["alpha_along_long"] = read_off(along.at_long.exponent, along.at_long);
    result.scalars["alpha_across_short"] = read_off(across.at_short.exponent, across.at_short);
    result.scalars["alpha_across_long"] = read_off(across.at_long.exponent, across.at_long);
    result.scalars["diffusion_lag_from_s"] = {{total.at_long.lag_from}};
    result.scalars["diffusion_lag_to_s"] = {{total.at_long.lag_to}};
    result.scalars["diffusion_short_lag_from_s"] = {{total.at_short.lag_from}};
    result.scalars["diffusion_short_lag_to_s"] = {{total.at_short.lag_to}};
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
      .arrays =
          {
              called("lag", "t", {"lag_s", "lags"}),
              called("mean square displacement", R"(\mathrm{MSD})",
                     {"total_mm2", "mean square displacement in the plane", kWithError}),
              called("MSD along the director", "", {"along_mm2", "along the director", kWithError}),
              called("MSD across the director", "", {"across_mm2", "across the director", kWithError}),
              {"relative_total_mm2", "in the plane, without the common drift of all N rods, times N/(N − 1)",
               kWithError},
              {"relative_along_mm2", "along the director, without that drift", kWithError},
              {"relative_across_mm2", "across the director, without that drift", kWithError},
              {"d_total_mm2_s", "MSD / (4 lag)", kWithError},
              {"d_along_mm2_s", "MSD / (2 lag) of the displacement along the director", kWithError},
              {"d_across_mm2_s", "MSD / (2 lag) of the displacement across it", kWithError},
              {"exponent", "d ln(total) / d ln(lag)", kWithError},
          },
      .numbers =
          {
              called(
                  "diffusion coefficient", "D",
                  {"diffusion_mm2_s",
                   "D at long lags, from `diffusion_lag_from_s` to `diffusion_lag_to_s`: a quarter of the slope of the "
                   "MSD"}),
              {"diffusion_short_mm2_s",
               "the same at short lags, from `diffusion_short_lag_from_s` to `diffusion_short_lag_to_s`"},
              {"diffusion_along_mm2_s", "D along the director, at long lags"},
              {"diffusion_across_mm2_s", "D across it"},
              {"diffusion_relative_mm2_s", "D without the common drift of all rods, at long lags"},
              {"alpha_short", "exponent of the MSD at short lags"},
              {"alpha_long", "exponent at long lags"},
              {"alpha_along_short", "exponent of the displacement along the director, at short lags of its own"},
              {"alpha_along_long", "the same at long lags"},
              {"alpha_across_short", "exponent of the displacement across the director, at short lags of its own"},
              {"alpha_across_long", "the same at long lags"},
              {"diffusion_lag_from_s", "shortest of the long lags"},
              {"diffusion_lag_to_s", "longest of the long lags"},
              {"diffusion_short_lag_from_s", "shortest of the short lags"},
              {"diffusion_short_lag_to_s", "longest of the short lags"},
          },
      .of_axis = {"along_mm2", "across_mm2", "relative_along_mm2", "relative_across_mm2", "d_along_mm2_s",
                  "d_across_mm2_s", "diffusion_along_mm2_s", "diffusion_across_mm2_s", "alpha_along_short",
                  "alpha_along_long", "alpha_across_short", "alpha_across_long"},
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
