#include "analysis/lattice.h"

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

constexpr std::string_view kNoSix = "fewer than seven rods, of which none has six neighbours, or no sample";

/// Order of the places of the rods.
std::unique_ptr<Measurement> measure_lattice(const MeasureContext& context) {
  const double length = context.plan.system.rod.length, width = 2 * context.species.max_radius;
  const auto sample = [](const Sample& now, auto& lattice) {
    lattice.accumulate(now->time, now->position, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& lattice) {
    const auto means = block_estimates(lattice, result.t_steady, [](const analysis::LatticeOrder& part) {
      const analysis::LatticeMeans found = part.reduce();
      return std::vector<double>{found.psi_6, found.psi_6_local, found.psi_6_raw, found.bragg_peak};
    });
    result.scalars["psi_6"] = means[0];
    result.scalars["psi_6_local"] = means[1];
    result.scalars["psi_6_raw"] = means[2];
    result.scalars["bragg_peak"] = means[3];
  };
  return measured(
      sample, reduce,
      analysis::Blocked(analysis::LatticeOrder({context.plan.system.box(), length / width, width / 2, 2 * length})));
}

}  // namespace

MeasurementKind lattice_kind() {
  return {
      .name = "lattice",
      .sources = "lattice, geometry/wave_sums",
      .make = measure_lattice,
      .numbers =
          {
              {"psi_6", "|⟨ψ₆⟩| over the rods of an instant, in coordinates compressed along the director", false,
               kNoSix},
              {"psi_6_local", "⟨|ψ₆|⟩, without regard to the axes of other rods", false, kNoSix},
              {"psi_6_raw", "|⟨ψ₆⟩| in plain coordinates", false, kNoSix},
              {"bragg_peak", "largest Bragg peak: 1 for a perfect lattice"},
          },
  };
}

}  // namespace shaken::run
