#include <cmath>
#include <numbers>

#include "analysis/errors/blocked.h"
#include "analysis/number_fluctuations.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"
#include "sim/motion/side_walls.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_fluctuations(const MeasureContext& context) {
  const System& system = context.plan.system;
  analysis::NumberFluctuations::Where where;
  if (system.walls) {
    where = [walls = *system.walls, box = system.box()](const Vec2& centre, const Vec2& sides) {
      const double reach = walls.arena == Arena::kChannel ? sides.y() / 2 : sides.norm() / 2;
      return distance_to_walls(walls, box, Vec3(centre.x(), centre.y(), 0)) >= reach;
    };
  }
  const auto sample = [](const Sample& now, auto& counts) { counts.accumulate(now->time, now->position); };
  const auto reduce = [](Reduction& result, const auto& counts) {
    const analysis::NumberFluctuationCurve curve = analysis::NumberFluctuations::reduce(counts, result.t_steady);
    result.arrays["/fluctuations/area_fraction"] = curve.area_fraction;
    result.arrays["/fluctuations/mean_n"] = curve.mean_n;
    put(result, "/fluctuations/std_n", "", curve.std_n);
    put(result, "/fluctuations/std_n_without_map", "", curve.std_n_without_map);
    result.scalars["fluctuation_sizes"].value = static_cast<double>(curve.fitted);
    // In an arena boxes that lie within are fewer still.
    const char* reason = curve.fitted < analysis::NumberFluctuations::kMinSizes
                             ? "fewer than three sizes of boxes hold two rod lengths: a periodic box of at least eight "
                               "rod lengths has them"
                             : "the numbers do not vary";
    result.scalars["fluctuation_exponent"] = scalar_or(curve.exponent, reason);
    result.scalars["fluctuation_exponent_without_map"] = scalar_or(curve.exponent_without_map, reason);
  };
  return measured(
      sample, reduce,
      analysis::Blocked(analysis::NumberFluctuations(system.box(), system.area(), 2 * system.rod.length, where)));
}

}  // namespace

MeasurementKind fluctuations_kind() {
  return {
      .name = "fluctuations",
      .sources = "number_fluctuations",
      .make = measure_fluctuations,
      .arrays =
          {
              {"area_fraction", "area of a counting box as a fraction of the whole area"},
              called("mean number in a box", R"(\langle N\rangle)", {"mean_n", "mean number of rods in a box"}),
              called("its standard deviation", "ΔN",
                     {"std_n", "standard deviation of that number over boxes and time", kWithError}),
              {"std_n_without_map", "standard deviation over time, about each box's own mean", kWithError},
          },
      .axes = {{"", "mean_n"}},
      .numbers =
          {
              {"fluctuation_exponent",
               "x of ΔN ~ ⟨N⟩ˣ: 1/2 for rods that do not know of each other, up to 1 for giant fluctuations"},
              {"fluctuation_exponent_without_map", "the same of the fluctuations about the mean of each box"},
              {"fluctuation_sizes", "number of box sizes that the exponents are fitted to"},
          },
  };
}

}  // namespace shaken::run
