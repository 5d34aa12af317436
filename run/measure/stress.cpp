#include "analysis/stress.h"

#include <string>

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::Pressure;
using analysis::StressSeries;

template <std::size_t kComponent>
std::vector<double> kinetic(const StressSeries& series) {
  return series.kinetic(kComponent);
}
template <std::size_t kComponent>
std::vector<double> collisional(const StressSeries& series) {
  return series.collisional(kComponent);
}

constexpr std::array kStressSeries{
    from<&StressSeries::times>(called(
        "time", "t", {"time_s", "ends of the times from one sample to the next, over which the following are means"})),
    from<kinetic<0>>({"kinetic_xx_pJ_mm2", "kinetic part of the pressure tensor, N/(N − 1) Σ m δv δv per area"}),
    from<kinetic<1>>({"kinetic_xy_pJ_mm2", "its component xy"}),
    from<kinetic<2>>({"kinetic_yx_pJ_mm2", "the same"}),
    from<kinetic<3>>({"kinetic_yy_pJ_mm2", "its component yy"}),
    from<collisional<0>>(
        called("pressure of impacts, xx", "P_{xx}",
               {"collisional_xx_pJ_mm2", "collisional part: distance times impulse, of all impacts of two rods"})),
    from<collisional<1>>({"collisional_xy_pJ_mm2", "its component xy: way along x, impulse along y"}),
    from<collisional<2>>({"collisional_yx_pJ_mm2", "its component yx, which differs where impacts turn rods"}),
    from<collisional<3>>(called("pressure of impacts, yy", "P_{yy}", {"collisional_yy_pJ_mm2", "its component yy"})),
};
constexpr std::array kStressNumbers{
    from<[](const Pressure& p) { return p.kinetic + p.collisional; }>(
        called("pressure", "p", {"pressure_pJ_mm2", "pressure in the plane: half the trace of both parts"})),
    from<&Pressure::collisional>(called("pressure of impacts", R"(p_\mathrm{c})",
                                        {"pressure_collisional_pJ_mm2", "of this the part of impacts"})),
    from<&Pressure::along>(
        called("pressure along the director", "p_∥",
               of_axis({"pressure_along_pJ_mm2", "component of both parts along the director of each sample"}))),
    from<&Pressure::across>(
        called("pressure across the director", "p_⊥", of_axis({"pressure_across_pJ_mm2", "that across it"}))),
};

std::unique_ptr<Measurement> measure_stress(const MeasureContext& context) {
  const double area = context.run.system.area();
  const auto n_rods = static_cast<std::size_t>(context.run.system.n_all_rods());
  const auto sample = [area](const Sample& now, auto& series) {
    series.accumulate(now->time, now.totals().stress, area, now.order().director);
  };
  const auto reduce = [n_rods](Reduction& result, const auto& series) {
    put(result, "/stress/", kStressSeries, series);
    put(result, "", kStressNumbers, series.sums(),
        [&](const analysis::PressureSums& part) { return part.reduce(n_rods); });
    for (const auto& row : kStressNumbers) {
      Scalar& pressure = result.scalars[std::string(row.name)];
      if (n_rods == 1 && !is_known(pressure)) pressure.reason = "a single rod has no motion but that of all";
    }
  };
  return measured(sample, reduce, analysis::StressSeries(n_rods));
}

}  // namespace

MeasurementKind stress_kind() {
  return {
      .name = "stress",
      .sources = "stress",
      .make = measure_stress,
      .arrays = outputs_of(kStressSeries),
      .numbers = outputs_of(kStressNumbers),

      .needs = {Needs::kImpacts, Needs::kVelocities},
  };
}

}  // namespace shaken::run
