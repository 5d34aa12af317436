// SPDX-License-Identifier: MIT
#include "analysis/defect_maps.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/region.h"
#include "run/measure/estimates.h"
#include "run/measure/measure_defects.h"
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

class MeasuredDefectMaps : public Measurement {
 public:
  MeasuredDefectMaps(const System& system, const scene::MeasureDefectMaps& settings)
      : region_(system.box(), system.walls),
        smoothing_(settings.smoothing_for(system.rod.length)),
        mesh_(settings.grid_for(system.rod.length)),
        separation_(settings.separation_for(system.rod.length)),
        maps_(shape(settings.bins, settings.range_for(system.rod.length, system.box().shorter()))) {}

  void sample(const Sample& sample) override {
    const std::vector<analysis::Defect> defects = defects_of(sample, region_, smoothing_, mesh_);
    maps_.accumulate(sample->time, sample->position, sample.unwrapped(), sample->director,
                     analysis::lone_defects(defects, separation_, region_), region_);
  }
  void reduce(Reduction& result) const override {
    result.arrays["/defect_maps/along_mm"] = result.arrays["/defect_maps/across_mm"] = maps_.sums().empty().centres();
    put_maps("plus", &DefectMapSums::plus, result);
    put_maps("minus", &DefectMapSums::minus, result);
    const auto numbers = block_estimates(maps_.sums(), result.t_steady, [](const DefectMapSums& part) {
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
  }
  void save(StateWriter& writer) const override { maps_.save(writer); }
  void restore(StateReader& reader) override { maps_.restore(reader); }

 private:
  DefectMapSums::Shape shape(int bins, double range) const {
    range = std::min(range, region_.box().shorter() / 2);
    return {bins, range, std::min(smoothing_, range)};
  }
  void put_maps(const std::string& charge, MapOf map_of, Reduction& result) const {
    const DefectMap map = (maps_.sums().after(result.t_steady).*map_of)();
    const auto errors = block_errors(maps_.sums(), result.t_steady, [map_of](const DefectMapSums& part) {
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

  analysis::Region region_;
  double smoothing_, mesh_, separation_;  ///< [mm]
  analysis::DefectMaps maps_;
};

}  // namespace

MeasurementKind defect_maps_kind() {
  return {
      .name = "defect_maps",
      .sources = "defect_maps, defects, director_field, region",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredDefectMaps>(context.plan.system, *context.plan.defect_maps);
      },
      .arrays =
          {
              {"along_mm", "(bins) bin centres along x′: of +1/2 defects from the head to the tail"},
              {"across_mm", "(bins) bin centres along y′, to the left of x′"},
              {"plus/density",
               "(bins · bins) number density of rods about +1/2 defects over its mean, row by row: "
               "`density.reshape(bins, bins)[across, along]`",
               kWithError},
              {"plus/cos_2theta", "mean of cos 2θ′, θ′ being the angle of a rod to x′; in the same order", kWithError},
              {"plus/sin_2theta", "mean of sin 2θ′", kWithError},
              over("every", {"plus/v_along_mm_s", "mean velocity of rods along x′", kWithError}, 2),
              over("every", {"plus/v_across_mm_s", "that along y′", kWithError}, 2),
              {"plus/tilt_squared", "mean of n_z²", kWithError},
              {"minus/density", "the same about -1/2 defects, mean over their three rays", kWithError},
              {"minus/cos_2theta", "the same about -1/2 defects", kWithError},
              {"minus/sin_2theta", "the same about -1/2 defects", kWithError},
              over("every", {"minus/v_along_mm_s", "the same about -1/2 defects", kWithError}, 2),
              over("every", {"minus/v_across_mm_s", "the same about -1/2 defects", kWithError}, 2),
              {"minus/tilt_squared", "the same about -1/2 defects", kWithError},
          },
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
  };
}

}  // namespace shaken::run
