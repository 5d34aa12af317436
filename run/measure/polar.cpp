#include "analysis/errors/blocked.h"
#include "analysis/polar_order.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_polar(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& series, auto& statistics) {
    const analysis::PolarOrder order = analysis::polar_order(now->director);
    series.accumulate(now->time, order);
    statistics.accumulate(now->time, now->director, now->velocity, order);
  };
  const auto reduce = [n_rods = context.plan.system.n_rods](Reduction& result, const auto& series,
                                                            const auto& statistics) {
    result.arrays["/polar/time_s"] = series.times();
    result.arrays["/polar/order"] = series.orders();
    result.arrays["/polar/direction_rad"] = series.directions();
    const auto numbers = block_estimates(statistics, result.t_steady, [&](const analysis::PolarStatistics& part) {
      const analysis::PolarNumbers found = part.reduce();
      return std::vector<double>{found.order,     n_rods * found.variance, found.forward,
                                 found.along_rms, found.across_rms,        found.velocity_polarity};
    });
    result.scalars["P"] = numbers[0];
    result.scalars["polar_susceptibility"] = numbers[1];
    result.scalars["v_forward_mm_s"] = numbers[2];
    result.scalars["v_along_rms_mm_s"] = numbers[3];
    result.scalars["v_across_rms_mm_s"] = numbers[4];
    result.scalars["velocity_polarity"] = numbers[5];
  };
  return measured(sample, reduce, analysis::PolarSeries(), analysis::Blocked(analysis::PolarStatistics()));
}

}  // namespace

MeasurementKind polar_kind() {
  return {
      .name = "polar",
      .sources = "polar_order",
      .make = measure_polar,
      .arrays =
          {
              called("time", "t",
                     {"time_s", "times of P(t); of more than 65,536 samples, each point is a mean of several"}),
              called("polar order", "P", {"order", "P(t)"}),
              called("direction of the heads", "",
                     {"direction_rad", "angle to the x axis of the mean direction of the heads"}),
          },
      .numbers =
          {
              called("polar order", R"(\langle P\rangle)",
                     {"P", "mean polar order: 1 where all heads point the same way"}),
              {"polar_susceptibility", "N · var P"},
              called("velocity towards the head", R"(\langle v·u\rangle)",
                     {"v_forward_mm_s",
                      "mean of velocities of instants in the plane towards the head; negative: tails swim first"}),
              {"v_along_rms_mm_s", "root mean square of velocities of instants along the rod, in the plane"},
              {"v_across_rms_mm_s", "that across the rod"},
              {"velocity_polarity",
               "speed of the mean velocity over the mean speed: 1 where all rods move the same way"},
          },
      .needs = {Needs::kVelocities, Needs::kHeads},
  };
}

}  // namespace shaken::run
