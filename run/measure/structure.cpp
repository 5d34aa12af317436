// SPDX-License-Identifier: MIT
#include "analysis/structure_factor.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredStructure : public Measurement {
 public:
  explicit MeasuredStructure(const analysis::StructureFactor& empty) : structure_(empty) {}

  void sample(const Sample& sample) override {
    structure_.accumulate(sample->time, sample->position, sample->director);
  }
  void reduce(Reduction& result) const override {
    const analysis::StructureCurve curve = structure_.after(result.t_steady).reduce();
    const auto errors = block_errors(structure_, result.t_steady, [](const analysis::StructureFactor& part) {
      const analysis::StructureCurve found = part.reduce();
      return std::vector{found.all, found.along, found.across};
    });
    result.arrays["/structure/q_per_mm"] = curve.q;
    put(result, "/structure/factor", "", analysis::EstimateCurve{curve.all, errors[0]});
    put(result, "/structure/factor_along", "", analysis::EstimateCurve{curve.along, errors[1]});
    put(result, "/structure/factor_across", "", analysis::EstimateCurve{curve.across, errors[2]});
    result.scalars["structure_longest_wave"] = block_estimates(
        structure_, result.t_steady,
        [](const analysis::StructureFactor& part) { return std::vector<double>{part.reduce().all.front()}; })[0];
  }
  void save(StateWriter& writer) const override { structure_.save(writer); }
  void restore(StateReader& reader) override { structure_.restore(reader); }

 private:
  analysis::Blocked<analysis::StructureFactor> structure_;
};

}  // namespace

MeasurementKind structure_kind() {
  return {
      .name = "structure",
      .sources = "structure_factor, wave_sums",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredStructure>(
            analysis::StructureFactor(context.plan.system.box(), context.plan.structure->waves));
      },
      .arrays = {{"q_per_mm", "wave numbers 2πk/L, L being the longer side of the box"},
                 {"factor", "S(q) of the centres, mean over all directions of q", kWithError},
                 {"factor_along", "of wave vectors within 30° of the director", kWithError},
                 {"factor_across", "of wave vectors within 30° of its normal", kWithError}},
      .numbers = {{"structure_longest_wave", "S(2π/L): fluctuations of the density on the scale of the box"}},
      .of_axis = {"factor_along", "factor_across"},
  };
}

}  // namespace shaken::run
