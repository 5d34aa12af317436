#include "analysis/stress.h"

#include <array>
#include <string>

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

constexpr std::array kComponents{"xx", "xy", "yx", "yy"};

std::unique_ptr<Measurement> measure_stress(const MeasureContext& context) {
  const double area = context.run.system.area();
  const auto n_rods = static_cast<std::size_t>(context.run.system.n_all_rods());
  const auto sample = [area](const Sample& now, auto& series) {
    series.accumulate(now->time, now.totals().stress, area, now.order().director);
  };
  const auto reduce = [n_rods](Reduction& result, const auto& series) {
    const auto numbers = block_estimates(series.sums(), result.t_steady, [&](const analysis::PressureSums& part) {
      const analysis::Pressure p = part.reduce(n_rods);
      return std::vector<double>{p.kinetic + p.collisional, p.collisional, p.along, p.across};
    });
    result.arrays["/stress/time_s"] = series.times();
    for (std::size_t k = 0; k < kComponents.size(); ++k) {
      result.arrays[std::string("/stress/kinetic_") + kComponents[k] + "_pJ_mm2"] = series.kinetic(k);
      result.arrays[std::string("/stress/collisional_") + kComponents[k] + "_pJ_mm2"] = series.collisional(k);
    }
    const char* const names[] = {"pressure", "pressure_collisional", "pressure_along", "pressure_across"};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      Scalar& pressure = result.scalars[std::string(names[k]) + "_pJ_mm2"] = numbers[k];
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
      .arrays =
          {
              called("time", "t",
                     {"time_s", "ends of the times from one sample to the next, over which the following are means"}),
              {"kinetic_xx_pJ_mm2", "kinetic part of the pressure tensor, N/(N − 1) Σ m δv δv per area"},
              {"kinetic_xy_pJ_mm2", "its component xy"},
              {"kinetic_yx_pJ_mm2", "the same"},
              {"kinetic_yy_pJ_mm2", "its component yy"},
              called("pressure of impacts, xx", "P_{xx}",
                     {"collisional_xx_pJ_mm2", "collisional part: distance times impulse, of all impacts of two rods"}),
              {"collisional_xy_pJ_mm2", "its component xy: way along x, impulse along y"},
              {"collisional_yx_pJ_mm2", "its component yx, which differs where impacts turn rods"},
              called("pressure of impacts, yy", "P_{yy}", {"collisional_yy_pJ_mm2", "its component yy"}),
          },
      .numbers =
          {
              called("pressure", "p", {"pressure_pJ_mm2", "pressure in the plane: half the trace of both parts"}),
              called("pressure of impacts", R"(p_\mathrm{c})",
                     {"pressure_collisional_pJ_mm2", "of this the part of impacts"}),
              called("pressure along the director", "p_∥",
                     {"pressure_along_pJ_mm2", "component of both parts along the director of each sample"}),
              called("pressure across the director", "p_⊥", {"pressure_across_pJ_mm2", "that across it"}),
          },
      .of_axis = {"pressure_along_pJ_mm2", "pressure_across_pJ_mm2"},
      .needs = {Needs::kImpacts, Needs::kVelocities},
  };
}

}  // namespace shaken::run
