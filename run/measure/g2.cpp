#include "analysis/g2.h"

#include "analysis/errors/blocked.h"
#include "analysis/geometry/region.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_g2(const MeasureContext& context) {
  const System& system = context.plan.system;
  const analysis::Region region(system.box(), system.walls);
  const auto sample = [region](const Sample& now, auto& pairs) {
    pairs.accumulate(now->time, now->position, now->director, region);
  };
  const auto reduce = [](Reduction& result, const auto& pairs) {
    result.arrays["/g2/r_mm"] = pairs.empty().reduce().r;
    // Both curves one behind the other.
    const auto numbers = block_estimates(pairs, result.t_steady, [](const analysis::OrientationCorrelation& part) {
      analysis::OrientationCurve curve = part.reduce();
      curve.g2.insert(curve.g2.end(), curve.g.begin(), curve.g.end());
      return curve.g2;
    });
    analysis::EstimateCurve g2, g;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      (i < numbers.size() / 2 ? g2 : g).push_back({numbers[i].value, numbers[i].sem});
    }
    put(result, "/g2/g2", "", g2);
    put(result, "/g2/g", "", g);
  };
  return measured(
      sample, reduce,
      analysis::Blocked(analysis::OrientationCorrelation(context.plan.g2->bins, system.box().shorter() / 2)));
}

}  // namespace

MeasurementKind g2_kind() {
  return {
      .name = "g2",
      .sources = "g2, geometry/region",
      .make = measure_g2,
      .arrays =
          {
              called("distance", "r", {"r_mm", "bin centres"}),
              called("orientational correlation", "G_2(r)", {"g2", "G₂(r)", kWithError}),
              called("pair correlation", "g(r)", {"g", "g(r)", kWithError}),
          },
      .of_axis = {"g2"},
  };
}

}  // namespace shaken::run
