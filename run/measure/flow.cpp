#include <cmath>

#include "analysis/flow_correlation.h"
#include "analysis/geometry/region.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_flow(const MeasureContext& context) {
  const System& system = context.plan.system;
  const analysis::Region region(system.box(), system.walls);
  const double two_diameters = 4 * context.species.max_radius;
  const auto sample = [region](const Sample& now, auto& flow) {
    flow.accumulate(now->time, now->position, now.unwrapped(), now.order().director, region);
  };
  const auto reduce = [](Reduction& result, const auto& flow) {
    const analysis::FlowCurve curve = flow.sums().after(result.t_steady).reduce();
    const auto errors = block_errors(flow.sums(), result.t_steady, [](const analysis::FlowSums& part) {
      const analysis::FlowCurve found = part.reduce();
      return std::vector{found.c, found.along, found.across};
    });
    result.arrays["/flow/r_mm"] = curve.r;
    put(result, "/flow/c", "", analysis::EstimateCurve{curve.c, errors[0]});
    put(result, "/flow/c_along", "", analysis::EstimateCurve{curve.along, errors[1]});
    put(result, "/flow/c_across", "", analysis::EstimateCurve{curve.across, errors[2]});
    const auto numbers = block_estimates(flow.sums(), result.t_steady, [](const analysis::FlowSums& part) {
      const analysis::FlowCurve found = part.reduce();
      return std::vector<double>{found.near, found.length};
    });
    result.scalars["flow_of_neighbours"] = numbers[0];
    result.scalars["flow_length_mm"] = numbers[1];
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
      .arrays =
          {
              called("distance", "r", {"r_mm", "bin centres"}),
              over("every", called("velocity correlation", "C(r)",
                                   {"c", "C(r) of mean velocities; 1 if all rods move together", kWithError})),
              over("every", {"c_along", "of the components along the director", kWithError}),
              over("every", {"c_across", "of the components across it", kWithError}),
          },
      .numbers =
          {
              over("every", called("velocity correlation of neighbours", "C",
                                   {"flow_of_neighbours",
                                    "C of mean velocities of rods whose centres are less than two diameters apart"})),
              over("every", called("velocity correlation length", "ξ_v",
                                   {"flow_length_mm", "distance at which C falls to 1/e", false,
                                    "C does not fall to 1/e within half the box"})),
          },
      .of_axis = {"c_along", "c_across"},
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
