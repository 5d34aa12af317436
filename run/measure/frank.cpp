#include <algorithm>

#include "analysis/director_fluctuations.h"
#include "analysis/errors/blocked.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_frank(const MeasureContext& context) {
  const System& system = context.plan.system;
  // Elasticity is of waves long against a rod, three of them at least; the four longest of the box are always taken.
  const double three_rods = 2 * kPi / (3 * system.rod.length);
  const double longest = 2 * kPi / system.box_side * 1.5;
  const auto sample = [](const Sample& now, auto& waves) { waves.accumulate(now->time, now->position, now->director); };
  const auto reduce = [](Reduction& result, const auto& waves) {
    const analysis::DirectorSpectrum spectrum = analysis::DirectorFluctuations::reduce(waves, result.t_steady);
    result.arrays["/frank/q_along_per_mm"] = spectrum.q_along;
    result.arrays["/frank/q_across_per_mm"] = spectrum.q_across;
    result.arrays["/frank/fit_mm2"] = spectrum.fit;
    put(result, "/frank/power", "_mm2", spectrum.power);
    result.scalars["frank_ratio"] = scalar(spectrum.ratio);
    result.scalars["frank_splay"] = scalar(spectrum.splay);
    result.scalars["frank_bend"] = scalar(spectrum.bend);
    result.scalars["frank_chi2"].value = spectrum.chi2;
    result.scalars["frank_floor_mm2"].value = spectrum.floor;
  };
  return measured(sample, reduce,
                  analysis::Blocked(analysis::DirectorFluctuations(system.box_side, std::max(three_rods, longest))));
}

}  // namespace

MeasurementKind frank_kind() {
  return {
      .name = "frank",
      .sources = "director_fluctuations, geometry/wave_sums",
      .make = measure_frank,
      .arrays =
          {
              {"q_along_per_mm", "wave vectors, one entry each: component along the director"},
              {"q_across_per_mm", "component across it"},
              {"power_mm2", "power of the director fluctuations", kWithError},
              {"fit_mm2", "the same from the fitted Frank constants"},
          },
      .axes = {{"", ""}},
      .numbers =
          {
              {"frank_ratio", "K₃/K₁, bend over splay"},
              {"frank_splay", "K₁, in units of the effective temperature"},
              {"frank_bend", "K₃, in the same units"},
              {"frank_chi2", "χ² per degree of freedom of the fit: about 1 where the law holds"},
              {"frank_floor_mm2", "noise level: power of rods without correlation, which has been subtracted"},
          },
  };
}

}  // namespace shaken::run
