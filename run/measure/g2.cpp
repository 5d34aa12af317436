#include "analysis/g2.h"

#include "analysis/geometry/region.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::OrientationCurve;

constexpr std::array kG2Curves{
    from<&OrientationCurve::r>(called("distance", "r", {"r_mm", "bin centres"})),
    from<&OrientationCurve::g2>(called("orientational correlation", "G_2(r)", of_axis({"g2", "G₂(r)", kWithError}))),
    from<&OrientationCurve::g>(called("pair correlation", "g(r)", {"g", "g(r)", kWithError})),
};

std::unique_ptr<Measurement> measure_g2(const MeasureContext& context) {
  const System& system = context.plan.system;
  const analysis::Region region(system.box(), system.walls);
  const auto sample = [region](const Sample& now, auto& pairs) {
    pairs.accumulate(now->time, now->position, now->director, region);
  };
  const auto reduce = [](Reduction& result, const auto& pairs) { put(result, "/g2/", kG2Curves, pairs); };
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
      .arrays = outputs_of(kG2Curves),

  };
}

}  // namespace shaken::run
