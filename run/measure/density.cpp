#include <algorithm>
#include <cmath>

#include "analysis/density_maps.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"
#include "scene/keys/derived.h"

namespace shaken::run {
namespace {

using analysis::DensitySummary;
struct MapsOfDensity {
  std::vector<double> time, x, y, area_fraction;
};

constexpr std::array kDensityMaps{
    from<&MapsOfDensity::time>({"time_s", "(maps) middle of the time that a map is averaged over"}),
    from<&MapsOfDensity::x>(called("place", "x", {"x_mm", "(columns) centres of the cells along x"})),
    from<&MapsOfDensity::y>(called("place", "y", {"y_mm", "(rows) centres of the cells along y"})),
    from<&MapsOfDensity::area_fraction>(
        over("duration", called("area fraction", "φ",
                                {"area_fraction",
                                 "(maps · rows · columns) area fraction in the cells, map by map and row by row; "
                                 "NaN beyond walls"}))),
};
constexpr std::array kDensitySummary{
    from<&DensitySummary::mean>({"mean_area_fraction", "(rows · columns) mean over the maps of the steady state"}),
    from<&DensitySummary::lag>(called("lag", "t", {"memory/lag_s", "time from one map to another"})),
    from<&DensitySummary::correlation>(
        called("memory of the density", "C_φ(t)",
               {"memory/correlation", "⟨δ(t)δ(t + lag)⟩/⟨δ²⟩ of the relative deviations δ of cells from the mean"})),
};
constexpr std::array kDensityNumbers{
    from<&DensitySummary::variance>(
        over("duration",
             {"density_variance", "⟨δ²⟩ over cells and maps, δ being the relative deviation of a cell from the mean"})),
    from<&DensitySummary::variance_of_mean>(
        over("duration", {"density_variance_of_mean", "that of the mean map: what does not change in time"})),
    from<&DensitySummary::correlation_time>(
        over("duration", {"density_correlation_s", "lag at which the correlation falls to 1/e", false,
                          "it does not within the lags, or there are too few maps"})),
};

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
    const analysis::Grid& grid = maps.grid();
    MapsOfDensity found{maps.times(), centres(grid.columns, box.x() / grid.columns),
                        centres(grid.rows, box.y() / grid.rows), maps.densities()};
    DensitySummary summary = maps.reduce(result.t_steady);
    for (double& density : found.area_fraction) density *= area_fraction;
    for (double& density : summary.mean) density *= area_fraction;
    put(result, "/density/", kDensityMaps, found);
    put(result, "/density/", kDensitySummary, summary);
    put(result, "", kDensityNumbers, summary);
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
      .arrays = outputs_of(kDensityMaps, kDensitySummary),
      .axes = {{"area_fraction", "time_s y_mm x_mm"}, {"mean_area_fraction", "y_mm x_mm"}},
      .numbers = outputs_of(kDensityNumbers),
  };
}

}  // namespace shaken::run
