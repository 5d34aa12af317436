#include <cmath>

#include "analysis/number_fluctuations.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"
#include "sim/motion/side_walls.h"

namespace shaken::run {
namespace {

using analysis::NumberFluctuationCurve;

Scalar or_reason(const Estimate& exponent, const NumberFluctuationCurve& curve) {
  // In an arena boxes that lie within are fewer still.
  return scalar_or(exponent, curve.fitted < analysis::NumberFluctuations::kMinSizes
                                 ? "fewer than three sizes of boxes hold two rod lengths: a periodic box of at least "
                                   "eight rod lengths has them"
                                 : "the numbers do not vary");
}

constexpr std::array kFluctuationCurves{
    from<&NumberFluctuationCurve::area_fraction>(
        {"area_fraction", "area of a counting box as a fraction of the whole area"}),
    from<&NumberFluctuationCurve::mean_n>(
        called("mean number in a box", R"(\langle N\rangle)", {"mean_n", "mean number of rods in a box"})),
    from<&NumberFluctuationCurve::std_n>(
        called("its standard deviation", "ΔN", {"std_n", "standard deviation of that number over boxes and time"})),
    from<&NumberFluctuationCurve::std_n_without_map>(
        {"std_n_without_map", "standard deviation over time, about each box's own mean"}),
};
constexpr std::array kFluctuationNumbers{
    from<[](const NumberFluctuationCurve& curve) { return or_reason(curve.exponent, curve); }>(
        {"fluctuation_exponent",
         "x of ΔN ~ ⟨N⟩ˣ: 1/2 for rods that do not know of each other, up to 1 for giant fluctuations"}),
    from<[](const NumberFluctuationCurve& curve) { return or_reason(curve.exponent_without_map, curve); }>(
        {"fluctuation_exponent_without_map", "the same of the fluctuations about the mean of each box"}),
    from<[](const NumberFluctuationCurve& curve) { return static_cast<double>(curve.fitted); }>(
        {"fluctuation_sizes", "number of box sizes that the exponents are fitted to"}),
};

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
    const NumberFluctuationCurve curve = analysis::NumberFluctuations::reduce(counts, result.t_steady);
    put(result, "/fluctuations/", kFluctuationCurves, curve);
    put(result, "", kFluctuationNumbers, curve);
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
      .arrays = outputs_of(kFluctuationCurves),
      .axes = {{"", "mean_n"}},
      .numbers = outputs_of(kFluctuationNumbers),
  };
}

}  // namespace shaken::run
