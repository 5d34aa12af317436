
#include "analysis/flow_correlation.h"
#include "analysis/geometry/region.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::FlowCurve;

constexpr std::array kFlowCurves{
    from<&FlowCurve::r>(called("distance", "r", {"r_mm", "bin centres"})),
    from<&FlowCurve::c>(
        over("every", called("velocity correlation", "C(r)",
                             {"c", "C(r) of mean velocities; 1 if all rods move together", kWithError}))),
    from<&FlowCurve::along>(over("every", of_axis({"c_along", "of the components along the director", kWithError}))),
    from<&FlowCurve::across>(over("every", of_axis({"c_across", "of the components across it", kWithError}))),
};
constexpr std::array kFlowNumbers{
    from<&FlowCurve::near>(
        over("every", called("velocity correlation of neighbours", "C",
                             {"flow_of_neighbours",
                              "C of mean velocities of rods whose centres are less than two diameters apart"}))),
    from<&FlowCurve::length>(over("every", called("velocity correlation length", "ξ_v",
                                                  {"flow_length_mm", "distance at which C falls to 1/e", false,
                                                   "C does not fall to 1/e within half the box"}))),
};

std::unique_ptr<Measurement> measure_flow(const MeasureContext& context) {
  const System& system = context.plan.system;
  const analysis::Region region(system.box(), system.walls);
  const double two_diameters = 4 * context.species.max_radius;
  const auto sample = [region](const Sample& now, auto& flow) {
    flow.accumulate(now->time, now->position, now.unwrapped(), now.order().director, region);
  };
  const auto reduce = [](Reduction& result, const auto& flow) {
    put(result, "/flow/", kFlowCurves, flow.sums());
    put(result, "", kFlowNumbers, flow.sums());
  };
  return measured(sample, reduce,
                  analysis::FlowCorrelation(context.plan.flow->bins, system.box().shorter() / 2, two_diameters));
}

}  // namespace

MeasurementKind flow_kind() {
  return {
      .name = "flow",
      .sources = "flow_correlation, geometry/region",
      .make = measure_flow,
      .only_steady = true,
      .arrays = outputs_of(kFlowCurves),
      .numbers = outputs_of(kFlowNumbers),

      .needs = {Needs::kIdentities, Needs::kEveryRod},
  };
}

}  // namespace shaken::run
