#include "analysis/structure_factor.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::StructureCurve;

constexpr std::array kStructureCurves{
    from<&StructureCurve::q>(
        called("wave number", "q", {"q_per_mm", "wave numbers 2πk/L, L being the longer side of the box"})),
    from<&StructureCurve::all>(called("structure factor", "S(q)",
                                      {"factor", "S(q) of the centres, mean over all directions of q", kWithError})),
    from<&StructureCurve::along>(of_axis({"factor_along", "of wave vectors within 30° of the director", kWithError})),
    from<&StructureCurve::across>(of_axis({"factor_across", "of wave vectors within 30° of its normal", kWithError})),
};
constexpr std::array kStructureNumbers{
    from<[](const StructureCurve& curve) { return curve.all.front(); }>(
        {"structure_longest_wave", "S(2π/L): fluctuations of the density on the scale of the box"}),
};

std::unique_ptr<Measurement> measure_structure(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& structure) {
    structure.accumulate(now->time, now->position, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& structure) {
    put(result, "/structure/", kStructureCurves, structure);
    put(result, "", kStructureNumbers, structure);
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
      .arrays = outputs_of(kStructureCurves),
      .numbers = outputs_of(kStructureNumbers),

  };
}

}  // namespace shaken::run
