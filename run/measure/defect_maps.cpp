#include "analysis/defect_maps.h"

#include <algorithm>

#include "analysis/geometry/region.h"
#include "run/measure/measure_defects.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::DefectMap;
using analysis::DefectMapSums;

struct MapsOfBoth {
  DefectMap plus, minus;
  double samples;
};

constexpr std::array kMapAxes{
    from<&DefectMapSums::centres>(
        called("along the defect", "x′",
               {"along_mm", "(bins) bin centres along x′: of +1/2 defects from the head to the tail"})),
    from<&DefectMapSums::centres>(
        called("across the defect", "y′", {"across_mm", "(bins) bin centres along y′, to the left of x′"})),
};
constexpr std::array kMapPlus{
    from<&DefectMap::density>(
        called("density of rods over its mean", "",
               {"plus/density",
                "(bins · bins) number density of rods about +1/2 defects over its mean, row by row: "
                "`density.reshape(bins, bins)[across, along]`",
                kWithError})),
    from<&DefectMap::cos2>(
        {"plus/cos_2theta", "mean of cos 2θ′, θ′ being the angle of a rod to x′; in the same order", kWithError}),
    from<&DefectMap::sin2>({"plus/sin_2theta", "mean of sin 2θ′", kWithError}),
    from<&DefectMap::v_along>(over(
        "every",
        called("velocity of rods along $x′$", "", {"plus/v_along_mm_s", "mean velocity of rods along x′", kWithError}),
        2)),
    from<&DefectMap::v_across>(over(
        "every", called("velocity of rods along $y′$", "", {"plus/v_across_mm_s", "that along y′", kWithError}), 2)),
    from<&DefectMap::tilt2>({"plus/tilt_squared", "mean of n_z²", kWithError}),
};
constexpr std::array kMapMinus{
    from<&DefectMap::density>({"minus/density", "the same about -1/2 defects, mean over their three rays", kWithError}),
    from<&DefectMap::cos2>({"minus/cos_2theta", "the same about -1/2 defects", kWithError}),
    from<&DefectMap::sin2>({"minus/sin_2theta", "the same about -1/2 defects", kWithError}),
    from<&DefectMap::v_along>(over("every", {"minus/v_along_mm_s", "the same about -1/2 defects", kWithError}, 2)),
    from<&DefectMap::v_across>(over("every", {"minus/v_across_mm_s", "the same about -1/2 defects", kWithError}, 2)),
    from<&DefectMap::tilt2>({"minus/tilt_squared", "the same about -1/2 defects", kWithError}),
};
constexpr std::array kMapNumbers{
    from<[](const MapsOfBoth& both) { return both.plus.defects / both.samples; }>(
        {"mapped_defects_plus", "number of +1/2 defects that are mapped, of a sample"}),
    from<[](const MapsOfBoth& both) { return both.minus.defects / both.samples; }>(
        {"mapped_defects_minus", "number of -1/2 defects that are mapped"}),
    from<[](const MapsOfBoth& both) { return both.plus.core_density; }>(
        {"core_density_plus", "density of rods nearer to a +1/2 defect than the smoothing, over its mean", false,
         "no defects"}),
    from<[](const MapsOfBoth& both) { return both.minus.core_density; }>(
        {"core_density_minus", "the same about -1/2 defects", false, "no defects"}),
    from<[](const MapsOfBoth& both) { return both.plus.core_along; }>(
        over("every",
             {"core_flow_along_mm_s",
              "mean velocity of rods there along the tail of a +1/2 defect; negative: towards the head", false,
              "no defects"},
             2)),
    from<[](const MapsOfBoth& both) { return both.plus.core_across; }>(
        over("every", {"core_flow_across_mm_s", "that across the tail, to the left", false, "no defects"}, 2)),
};

std::unique_ptr<Measurement> measure_defect_maps(const MeasureContext& context) {
  const System& system = context.plan.system;
  const scene::MeasureDefectMaps& settings = *context.plan.defect_maps;
  const double length = system.rod.length, side = system.box().shorter();
  const double smoothing = settings.smoothing_for(length), separation = settings.separation_for(length);
  const double range = std::min(settings.range_for(length, side), side / 2);
  const auto sample = [region = analysis::Region(system.box(), system.walls), smoothing,
                       mesh = settings.grid_for(length), separation](const Sample& now, auto& maps) {
    const std::vector<analysis::Defect> defects = defects_of(now, region, smoothing, mesh);
    maps.accumulate(now->time, now->position, now.unwrapped(), now->director,
                    analysis::lone_defects(defects, separation, region), region);
  };
  const auto reduce = [](Reduction& result, const auto& maps) {
    put(result, "/defect_maps/", kMapAxes, maps.sums().empty());
    put(result, "/defect_maps/", kMapPlus, maps.sums(), &DefectMapSums::plus);
    put(result, "/defect_maps/", kMapMinus, maps.sums(), &DefectMapSums::minus);
    put(result, "", kMapNumbers, maps.sums(), [](const DefectMapSums& part) {
      return MapsOfBoth{part.plus(), part.minus(), static_cast<double>(part.samples())};
    });
  };
  return measured(sample, reduce, analysis::DefectMaps({settings.bins, range, std::min(smoothing, range)}));
}

}  // namespace

MeasurementKind defect_maps_kind() {
  return {
      .name = "defect_maps",
      .sources = "defect_maps, defects, geometry/director_field, geometry/region",
      .make = measure_defect_maps,
      .arrays = outputs_of(kMapAxes, kMapPlus, kMapMinus),
      .axes = {{"plus/", "across_mm along_mm"}, {"minus/", "across_mm along_mm"}},
      .numbers = outputs_of(kMapNumbers),
      .needs = {Needs::kIdentities, Needs::kEveryRod},
  };
}

}  // namespace shaken::run
