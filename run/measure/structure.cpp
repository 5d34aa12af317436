#include "analysis/structure_factor.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_structure(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& structure) {
    structure.accumulate(now->time, now->position, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& structure) {
    const analysis::StructureCurve curve = structure.after(result.t_steady).reduce();
    const auto errors = block_errors(structure, result.t_steady, [](const analysis::StructureFactor& part) {
      const analysis::StructureCurve found = part.reduce();
      return std::vector{found.all, found.along, found.across};
    });
    result.arrays["/structure/q_per_mm"] = curve.q;
    put(result, "/structure/factor", "", analysis::EstimateCurve{curve.all, errors[0]});
    put(result, "/structure/factor_along", "", analysis::EstimateCurve{curve.along, errors[1]});
    put(result, "/structure/factor_across", "", analysis::EstimateCurve{curve.across, errors[2]});
    result.scalars["structure_longest_wave"] = block_estimates(
        structure, result.t_steady,
        [](const analysis::StructureFactor& part) { return std::vector<double>{part.reduce().all.front()}; })[0];
  };
  return measured(
      sample, reduce,
      analysis::Blocked(analysis::StructureFactor(context.plan.system.box(), context.plan.structure->waves)));
}

}  // namespace

MeasurementKind structure_kind() {
  return {
      .name = "structure",
      .sources = "structure_factor, geometry/wave_sums",
      .make = measure_structure,
      .arrays = {called("wave number", "q", {"q_per_mm", "wave numbers 2πk/L, L being the longer side of the box"}),
                 called("structure factor", "S(q)",
                        {"factor", "S(q) of the centres, mean over all directions of q", kWithError}),
                 {"factor_along", "of wave vectors within 30° of the director", kWithError},
                 {"factor_across", "of wave vectors within 30° of its normal", kWithError}},
      .numbers = {{"structure_longest_wave", "S(2π/L): fluctuations of the density on the scale of the box"}},
      .of_axis = {"factor_along", "factor_across"},
  };
}

}  // namespace shaken::run
