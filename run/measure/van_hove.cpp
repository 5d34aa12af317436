#include "analysis/van_hove.h"

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_van_hove(const MeasureContext& context) {
  const scene::MeasureVanHove& settings = *context.plan.van_hove;
  const double range = settings.range_for(context.plan.system.rod.length);
  const auto sample = [](const Sample& now, auto& van_hove) {
    van_hove.accumulate(now->time, now.unwrapped(), now.order().director);
  };
  const auto reduce = [](Reduction& result, const auto& van_hove) {
    // Rows by lag, one behind the other.
    std::vector<double> lags, displacements;
    analysis::EstimateCurve along, across, distance;
    for (std::size_t k = 0; k < van_hove.n_lags(); ++k) {
      const auto& samples = van_hove.displacements(k);
      lags.push_back(van_hove.lag(k));
      const std::vector<double> centres = samples.empty().reduce().displacement;
      displacements.insert(displacements.end(), centres.begin(), centres.end());
      const auto points = block_estimates(samples, result.t_steady, [](const analysis::DisplacementHistogram& part) {
        const analysis::DisplacementCurve found = part.reduce();
        std::vector<double> all = found.along;
        all.insert(all.end(), found.across.begin(), found.across.end());
        all.insert(all.end(), found.distance.begin(), found.distance.end());
        all.push_back(found.beyond);
        return all;
      });
      const std::size_t bins = centres.size();
      for (std::size_t i = 0; i < 3 * bins; ++i) {
        (i < bins ? along : i < 2 * bins ? across : distance).push_back(points[i]);
      }
      result.scalars["van_hove_beyond"] = points.back();
    }
    result.arrays["/van_hove/lag_s"] = lags;
    result.arrays["/van_hove/displacement_mm"] = displacements;
    put(result, "/van_hove/along_per_mm", along);
    put(result, "/van_hove/across_per_mm", across);
    put(result, "/van_hove/distance_per_mm", distance);
  };
  return measured(sample, reduce, analysis::VanHove(context.interval, settings.lag, settings.bins, range));
}

}  // namespace

MeasurementKind van_hove_kind() {
  return {
      .name = "van_hove",
      .sources = "van_hove",
      .make = measure_van_hove,
      .only_steady = true,
      .arrays =
          {
              {"lag_s", "(lags) lags, at most four"},
              called("displacement along the director", "x",
                     {"displacement_mm", "(lags · bins) bin centres of x, whose sign does not count, row by row"}),
              called("van Hove function", "G_s(x, t)",
                     of_axis({"along_per_mm", "(lags · bins) G_s(x, t) of displacements x along the director",
                              kWithError})),
              of_axis({"across_per_mm", "(lags · bins) of those across it", kWithError}),
              {"distance_per_mm", "(lags · bins) density 2πr G_s(r, t) of the distance r in the plane", kWithError},
          },
      .axes = {{"", "lag_s displacement_mm"}},
      .numbers =
          {
              over("lag", {"van_hove_beyond", "share of the displacements that lie beyond the range"}),
          },

      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
