#include "analysis/drift.h"

#include <vector>

#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_drift(const MeasureContext&) {
  const auto sample = [](const Sample& now, auto& drift) { drift.accumulate(now->time, now.unwrapped()); };
  const auto reduce = [](Reduction& result, const auto& drift) {
    const auto velocity =
        block_estimates(drift.statistics(), result.t_steady, [](const analysis::DriftStatistics& part) {
          const Vec2 mean = part.reduce();
          return std::vector<double>{mean.x(), mean.y()};
        });
    result.arrays["/drift/time_s"] = drift.times();
    result.arrays["/drift/x_mm"] = drift.x();
    result.arrays["/drift/y_mm"] = drift.y();
    result.scalars["drift_x_mm_s"] = velocity[0];
    result.scalars["drift_y_mm_s"] = velocity[1];
  };
  return measured(sample, reduce, analysis::Drift());
}

}  // namespace

MeasurementKind drift_kind() {
  return {
      .name = "drift",
      .sources = "drift",
      .make = measure_drift,
      .arrays =
          {
              called("time", "t", {"time_s", "times; of more than 65,536 samples, each point is a mean of several"}),
              called("displacement along x", "x",
                     {"x_mm", "displacement along x of the mean of all centres since the first sample"}),
              called("displacement along y", "y", {"y_mm", "the same along y"}),
          },
      .numbers =
          {
              called("drift velocity along x", "v_x", {"drift_x_mm_s", "mean velocity of all rods along x"}),
              called("drift velocity along y", "v_y", {"drift_y_mm_s", "mean velocity of all rods along y"}),
          },
      .needs = {Needs::kIdentities},
  };
}

}  // namespace shaken::run
