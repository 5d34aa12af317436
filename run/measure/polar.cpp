#include "analysis/polar_order.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::PolarNumbers;
using analysis::PolarSeries;

constexpr std::array kPolarSeries{
    from<&PolarSeries::times>(
        called("time", "t", {"time_s", "times of P(t); of more than 65,536 samples, each point is a mean of several"})),
    from<&PolarSeries::orders>(called("polar order", "P", {"order", "P(t)"})),
    from<&PolarSeries::directions>(called("direction of the heads", "",
                                          {"direction_rad", "angle to the x axis of the mean direction of the heads"})),
};
constexpr std::array kPolarNumbers{
    from<&PolarNumbers::order>(
        called("polar order", R"(\langle P\rangle)", {"P", "mean polar order: 1 where all heads point the same way"})),
    from<&PolarNumbers::variance>({"polar_susceptibility", "N · var P"}),
    from<&PolarNumbers::forward>(
        called("velocity towards the head", R"(\langle v·u\rangle)",
               {"v_forward_mm_s",
                "mean of velocities of instants in the plane towards the head; negative: tails swim first"})),
    from<&PolarNumbers::along_rms>(
        {"v_along_rms_mm_s", "root mean square of velocities of instants along the rod, in the plane"}),
    from<&PolarNumbers::across_rms>({"v_across_rms_mm_s", "that across the rod"}),
    from<&PolarNumbers::velocity_polarity>(
        {"velocity_polarity", "speed of the mean velocity over the mean speed: 1 where all rods move the same way"}),
};

std::unique_ptr<Measurement> measure_polar(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& series, auto& statistics) {
    const analysis::PolarOrder order = analysis::polar_order(now->director);
    series.accumulate(now->time, order);
    statistics.accumulate(now->time, now->director, now->velocity, order);
  };
  const auto reduce = [n_rods = context.plan.system.n_rods](Reduction& result, const auto& series,
                                                            const auto& statistics) {
    put(result, "/polar/", kPolarSeries, series);
    put(result, "", kPolarNumbers, statistics, [&](const analysis::PolarStatistics& part) {
      PolarNumbers found = part.reduce();
      found.variance *= n_rods;
      return found;
    });
  };
  return measured(sample, reduce, analysis::PolarSeries(), analysis::Blocked(analysis::PolarStatistics()));
}

}  // namespace

MeasurementKind polar_kind() {
  return {
      .name = "polar",
      .sources = "polar_order",
      .make = measure_polar,
      .arrays = outputs_of(kPolarSeries),
      .numbers = outputs_of(kPolarNumbers),
      .needs = {Needs::kVelocities, Needs::kHeads},
  };
}

}  // namespace shaken::run
