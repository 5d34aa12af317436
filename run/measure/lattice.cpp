#include "analysis/lattice.h"

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::LatticeMeans;

constexpr std::string_view kNoSix = "fewer than seven rods, of which none has six neighbours, or no sample";
constexpr std::array kLatticeNumbers{
    from<&LatticeMeans::psi_6>(
        {"psi_6", "|⟨ψ₆⟩| over the rods of an instant, in coordinates compressed along the director", false, kNoSix}),
    from<&LatticeMeans::psi_6_local>(
        {"psi_6_local", "⟨|ψ₆|⟩, without regard to the axes of other rods", false, kNoSix}),
    from<&LatticeMeans::psi_6_raw>({"psi_6_raw", "|⟨ψ₆⟩| in plain coordinates", false, kNoSix}),
    from<&LatticeMeans::bragg_peak>({"bragg_peak", "largest Bragg peak: 1 for a perfect lattice"}),
};

/// Order of the places of the rods.
std::unique_ptr<Measurement> measure_lattice(const MeasureContext& context) {
  const double length = context.plan.system.rod.length, width = 2 * context.species.max_radius;
  const auto sample = [](const Sample& now, auto& lattice) {
    lattice.accumulate(now->time, now->position, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& lattice) { put(result, "", kLatticeNumbers, lattice); };
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
      .numbers = outputs_of(kLatticeNumbers),
  };
}

}  // namespace shaken::run
