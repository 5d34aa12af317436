// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>

#include "analysis/flow_correlation.h"
#include "analysis/region.h"
#include "analysis/steady.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredFlow : public Measurement {
 public:
  MeasuredFlow(int bins, double near, const analysis::Region& region, std::optional<double> steady)
      : steady_(steady), region_(region), flow_(bins, region.box().shorter() / 2, near) {}

  void sample(const Sample& sample) override {
    if (!analysis::is_steady(sample->time, steady_.value_or(0.0))) return;
    flow_.accumulate(sample->time, sample->position, sample.unwrapped(), sample.order().director, region_);
  }
  void reduce(Reduction& result) const override {
    const double from = steady_.value_or(result.t_steady);
    const analysis::FlowCurve curve = flow_.sums().after(from).reduce();
    const auto errors = block_errors(flow_.sums(), from, [](const analysis::FlowSums& part) {
      const analysis::FlowCurve found = part.reduce();
      return std::vector{found.c, found.along, found.across};
    });
    result.arrays["/flow/r_mm"] = curve.r;
    put(result, "/flow/c", "", analysis::EstimateCurve{curve.c, errors[0]});
    put(result, "/flow/c_along", "", analysis::EstimateCurve{curve.along, errors[1]});
    put(result, "/flow/c_across", "", analysis::EstimateCurve{curve.across, errors[2]});
    const auto numbers = block_estimates(flow_.sums(), from, [](const analysis::FlowSums& part) {
      const analysis::FlowCurve found = part.reduce();
      return std::vector<double>{found.near, found.length};
    });
    result.scalars["flow_of_neighbours"] = numbers[0];
    result.scalars["flow_length_mm"] = numbers[1];
  }
  void save(StateWriter& writer) const override { flow_.save(writer); }
  void restore(StateReader& reader) override { flow_.restore(reader); }

 private:
  std::optional<double> steady_;  ///< [s]; given, it leaves out what is before, or else the reduction does
  analysis::Region region_;
  analysis::FlowCorrelation flow_;
};

}  // namespace

MeasurementKind flow_kind() {
  return {
      .name = "flow",
      .sources = "flow_correlation, region",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        const System& system = context.plan.system;
        const double two_diameters = 4 * context.species.max_radius;
        return std::make_unique<MeasuredFlow>(context.plan.flow->bins, two_diameters,
                                              analysis::Region(system.box(), system.walls), context.plan.steady);
      },
      .arrays =
          {
              {"r_mm", "bin centres"},
              over("every", {"c", "C(r) of mean velocities; 1 if all rods move together", kWithError}),
              over("every", {"c_along", "of the components along the director", kWithError}),
              over("every", {"c_across", "of the components across it", kWithError}),
          },
      .numbers =
          {
              over("every", {"flow_of_neighbours",
                             "C of mean velocities of rods whose centres are less than two diameters apart"}),
              over("every", {"flow_length_mm", "distance at which C falls to 1/e", false,
                             "C does not fall to 1/e within half the box"}),
          },
      .of_axis = {"c_along", "c_across"},
  };
}

}  // namespace shaken::run
