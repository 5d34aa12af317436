#include "analysis/defect_maps.h"

#include <algorithm>
#include <string>
#include <vector>

#include "analysis/geometry/region.h"
#include "run/measure/estimates.h"
#include "run/measure/measure_defects.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

using analysis::DefectMap;
using analysis::DefectMapSums;

struct MapArray {
  const char *name, *unit;
  std::vector<double> DefectMap::*values;
};
constexpr MapArray kMapArrays[] = {
    {"density", "", &DefectMap::density},        {"cos_2theta", "", &DefectMap::cos2},
    {"sin_2theta", "", &DefectMap::sin2},        {"v_along", "_mm_s", &DefectMap::v_along},
    {"v_across", "_mm_s", &DefectMap::v_across}, {"tilt_squared", "", &DefectMap::tilt2},
};

/// What sums say about the defects of one charge.
using MapOf = DefectMap (DefectMapSums::*)() const;

void put_maps(const std::string& charge, MapOf map_of, const analysis::Blocked<DefectMapSums>& sums,
              Reduction& result) {
  const DefectMap map = (sums.after(result.t_steady).*map_of)();
  const auto errors = block_errors(sums, result.t_steady, [map_of](const DefectMapSums& part) {
    const DefectMap found = (part.*map_of)();
    std::vector<std::vector<double>> curves;
    for (const MapArray& array : kMapArrays) curves.push_back(found.*array.values);
    return curves;
  });
  std::size_t k = 0;
  for (const MapArray& array : kMapArrays) {
    put(result, "/defect_maps/" + charge + "/" + array.name, array.unit,
        analysis::EstimateCurve{map.*array.values, errors[k++]});
  }
}

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
    result.arrays["/defect_maps/along_mm"] = result.arrays["/defect_maps/across_mm"] = maps.sums().empty().centres();
    put_maps("plus", &DefectMapSums::plus, maps.sums(), result);
    put_maps("minus", &DefectMapSums::minus, maps.sums(), result);
    const auto numbers = block_estimates(maps.sums(), result.t_steady, [](const DefectMapSums& part) {
      const DefectMap plus = part.plus(), minus = part.minus();
      const auto samples = static_cast<double>(part.samples());
      return std::vector<double>{plus.defects / samples, minus.defects / samples, plus.core_density,
                                 minus.core_density,     plus.core_along,         plus.core_across};
    });
    result.scalars["mapped_defects_plus"] = numbers[0];
    result.scalars["mapped_defects_minus"] = numbers[1];
    result.scalars["core_density_plus"] = numbers[2];
    result.scalars["core_density_minus"] = numbers[3];
    result.scalars["core_flow_along_mm_s"] = numbers[4];
    result.scalars["core_flow_across_mm_s"] = numbers[5];
  };
  return measured(sample, reduce, analysis::DefectMaps({settings.bins, range, std::min(smoothing, range)}));
}

}  // namespace

MeasurementKind defect_maps_kind() {
  return {
      .name = "defect_maps",
      .sources = "defect_maps, defects, geometry/director_field, geometry/region",
      .make = measure_defect_maps,
      .arrays =
          {
              called("along the defect", "x′",
                     {"along_mm", "(bins) bin centres along x′: of +1/2 defects from the head to the tail"}),
              called("across the defect", "y′", {"across_mm", "(bins) bin centres along y′, to the left of x′"}),
              called("density of rods over its mean", "",
                     {"plus/density",
                      "(bins · bins) number density of rods about +1/2 defects over its mean, row by row: "
                      "`density.reshape(bins, bins)[across, along]`",
                      kWithError}),
              {"plus/cos_2theta", "mean of cos 2θ′, θ′ being the angle of a rod to x′; in the same order", kWithError},
              {"plus/sin_2theta", "mean of sin 2θ′", kWithError},
              over("every",
                   called("velocity of rods along $x′$", "",
                          {"plus/v_along_mm_s", "mean velocity of rods along x′", kWithError}),
                   2),
              over("every",
                   called("velocity of rods along $y′$", "", {"plus/v_across_mm_s", "that along y′", kWithError}), 2),
              {"plus/tilt_squared", "mean of n_z²", kWithError},
              {"minus/density", "the same about -1/2 defects, mean over their three rays", kWithError},
              {"minus/cos_2theta", "the same about -1/2 defects", kWithError},
              {"minus/sin_2theta", "the same about -1/2 defects", kWithError},
              over("every", {"minus/v_along_mm_s", "the same about -1/2 defects", kWithError}, 2),
              over("every", {"minus/v_across_mm_s", "the same about -1/2 defects", kWithError}, 2),
              {"minus/tilt_squared", "the same about -1/2 defects", kWithError},
          },
      .axes = {{"plus/", "across_mm along_mm"}, {"minus/", "across_mm along_mm"}},
      .numbers =
          {
              {"mapped_defects_plus", "number of +1/2 defects that are mapped, of a sample"},
              {"mapped_defects_minus", "number of -1/2 defects that are mapped"},
              {"core_density_plus", "density of rods nearer to a +1/2 defect than the smoothing, over its mean", false,
               "no defects"},
              {"core_density_minus", "the same about -1/2 defects", false, "no defects"},
              over("every",
                   {"core_flow_along_mm_s",
                    "mean velocity of rods there along the tail of a +1/2 defect; negative: towards the head", false,
                    "no defects"},
                   2),
              over("every", {"core_flow_across_mm_s", "that across the tail, to the left", false, "no defects"}, 2),
          },
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
