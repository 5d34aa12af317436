// SPDX-License-Identifier: MIT
#include "analysis/lattice.h"

#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

constexpr std::string_view kNoSix = "fewer than seven rods, of which none has six neighbours, or no sample";

/// Order of the places of the rods.
class MeasuredLattice : public Measurement {
 public:
  explicit MeasuredLattice(const analysis::LatticeOrder::Shape& shape) : lattice_(analysis::LatticeOrder(shape)) {}

  void sample(const Sample& sample) override { lattice_.accumulate(sample->time, sample->position, sample->director); }
  void reduce(Reduction& result) const override {
    const auto means = block_estimates(lattice_, result.t_steady, [](const analysis::LatticeOrder& lattice) {
      const analysis::LatticeMeans found = lattice.reduce();
      return std::vector<double>{found.psi_6, found.psi_6_local, found.psi_6_raw, found.bragg_peak};
    });
    result.scalars["psi_6"] = means[0];
    result.scalars["psi_6_local"] = means[1];
    result.scalars["psi_6_raw"] = means[2];
    result.scalars["bragg_peak"] = means[3];
  }
  void save(StateWriter& writer) const override { lattice_.save(writer); }
  void restore(StateReader& reader) override { lattice_.restore(reader); }

 private:
  analysis::Blocked<analysis::LatticeOrder> lattice_;
};

}  // namespace

MeasurementKind lattice_kind() {
  return {
      .name = "lattice",
      .sources = "lattice, wave_sums",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        const double length = context.plan.system.rod.length, width = 2 * context.species.max_radius;
        return std::make_unique<MeasuredLattice>(
            analysis::LatticeOrder::Shape{context.plan.system.box(), length / width, width / 2, 2 * length});
      },
      .numbers =
          {
              {"psi_6", "\\|⟨ψ₆⟩\\| over the rods of an instant, in coordinates compressed along the director", false,
               kNoSix},
              {"psi_6_local", "⟨\\|ψ₆\\|⟩, without regard to the axes of other rods", false, kNoSix},
              {"psi_6_raw", "\\|⟨ψ₆⟩\\| in plain coordinates", false, kNoSix},
              {"bragg_peak", "largest Bragg peak: 1 for a perfect lattice"},
          },
  };
}

}  // namespace shaken::run
