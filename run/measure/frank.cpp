#include <algorithm>

#include "analysis/director_fluctuations.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::DirectorSpectrum;

constexpr std::array kFrankSpectrum{
    from<&DirectorSpectrum::q_along>({"q_along_per_mm", "wave vectors, one entry each: component along the director"}),
    from<&DirectorSpectrum::q_across>({"q_across_per_mm", "component across it"}),
    from<&DirectorSpectrum::power>({"power_mm2", "power of the director fluctuations"}),
    from<&DirectorSpectrum::fit>({"fit_mm2", "the same from the fitted Frank constants"}),
};
constexpr std::array kFrankNumbers{
    from<&DirectorSpectrum::ratio>({"frank_ratio", "K₃/K₁, bend over splay"}),
    from<&DirectorSpectrum::splay>({"frank_splay", "K₁, in units of the effective temperature"}),
    from<&DirectorSpectrum::bend>({"frank_bend", "K₃, in the same units"}),
    from<&DirectorSpectrum::chi2>({"frank_chi2", "χ² per degree of freedom of the fit: about 1 where the law holds"}),
    from<&DirectorSpectrum::floor>(
        {"frank_floor_mm2", "noise level: power of rods without correlation, which has been subtracted"}),
};

std::unique_ptr<Measurement> measure_frank(const MeasureContext& context) {
  const System& system = context.plan.system;
  // Elasticity is of waves long against a rod, three of them at least; the four longest of the box are always taken.
  const double three_rods = 2 * kPi / (3 * system.rod.length);
  const double longest = 2 * kPi / system.box_side * 1.5;
  const auto sample = [](const Sample& now, auto& waves) { waves.accumulate(now->time, now->position, now->director); };
  const auto reduce = [](Reduction& result, const auto& waves) {
    const DirectorSpectrum spectrum = analysis::DirectorFluctuations::reduce(waves, result.t_steady);
    put(result, "/frank/", kFrankSpectrum, spectrum);
    put(result, "", kFrankNumbers, spectrum);
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
      .arrays = outputs_of(kFrankSpectrum),
      .axes = {{"", ""}},
      .numbers = outputs_of(kFrankNumbers),
  };
}

}  // namespace shaken::run
