#include <algorithm>
#include <cmath>

#include "analysis/density_maps.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"
#include "scene/keys/derived.h"

namespace shaken::run {
namespace {

std::vector<double> centres(int n, double mesh) {
  std::vector<double> at;
  at.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) at.push_back((k + 0.5) * mesh);
  return at;
}

std::unique_ptr<Measurement> measure_density(const MeasureContext& context) {
  const System& system = context.plan.system;
  const scene::MeasureDensity& settings = *context.plan.density;
  const auto sample = [](const Sample& now, auto& maps) { maps.accumulate(now->time, now->position); };
  const auto reduce = [area_fraction = scene::area_fraction_of(system), box = system.box()](Reduction& result,
                                                                                            const auto& maps) {
    const auto area_fractions = [&](std::vector<double> densities) {
      for (double& density : densities) density *= area_fraction;
      return densities;
    };
    const analysis::DensitySummary summary = maps.reduce(result.t_steady);
    result.arrays["/density/time_s"] = maps.times();
    result.arrays["/density/x_mm"] = centres(maps.grid().columns, box.x() / maps.grid().columns);
    result.arrays["/density/y_mm"] = centres(maps.grid().rows, box.y() / maps.grid().rows);
    result.arrays["/density/area_fraction"] = area_fractions(maps.densities());
    result.arrays["/density/mean_area_fraction"] = area_fractions(summary.mean);
    result.arrays["/density/memory/lag_s"] = summary.lag;
    put(result, "/density/memory/correlation", "", summary.correlation);
    result.scalars["density_variance"] = scalar(summary.variance);
    result.scalars["density_variance_of_mean"] = scalar(summary.variance_of_mean);
    result.scalars["density_correlation_s"] = scalar(summary.correlation_time);
  };
  return measured(
      sample, reduce,
      analysis::DensityMaps(analysis::Region(system.box(), system.walls),
                            analysis::Grid(system.box(), settings.grid_for(system.rod.length)), context.interval,
                            std::max<std::int64_t>(1, std::llround(settings.duration / context.interval))));
}

}  // namespace

MeasurementKind density_kind() {
  return {
      .name = "density",
      .sources = "density_maps, geometry/region",
      .make = measure_density,
      .arrays =
          {
              {"time_s", "(maps) middle of the time that a map is averaged over"},
              called("place", "x", {"x_mm", "(columns) centres of the cells along x"}),
              called("place", "y", {"y_mm", "(rows) centres of the cells along y"}),
              over("duration", called("area fraction", "φ",
                                      {"area_fraction",
                                       "(maps · rows · columns) area fraction in the cells, map by map and row by row; "
                                       "NaN beyond walls"})),
              {"mean_area_fraction", "(rows · columns) mean over the maps of the steady state"},
              called("lag", "t", {"memory/lag_s", "time from one map to another"}),
              called("memory of the density", "C_φ(t)",
                     {"memory/correlation", "⟨δ(t)δ(t + lag)⟩/⟨δ²⟩ of the relative deviations δ of cells from the mean",
                      kWithError}),
          },
      .axes = {{"area_fraction", "time_s y_mm x_mm"}, {"mean_area_fraction", "y_mm x_mm"}},
      .numbers =
          {
              over("duration", {"density_variance",
                                "⟨δ²⟩ over cells and maps, δ being the relative deviation of a cell from the mean"}),
              over("duration", {"density_variance_of_mean", "that of the mean map: what does not change in time"}),
              over("duration", {"density_correlation_s", "lag at which the correlation falls to 1/e", false,
                                "it does not within the lags, or there are too few maps"}),
          },
  };
}

}  // namespace shaken::run
