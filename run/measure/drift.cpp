#include "analysis/drift.h"

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::Drift;

constexpr std::array kDriftSeries{
    from<&Drift::times>(
        called("time", "t", {"time_s", "times; of more than 65,536 samples, each point is a mean of several"})),
    from<&Drift::x>(called("displacement along x", "x",
                           {"x_mm", "displacement along x of the mean of all centres since the first sample"})),
    from<&Drift::y>(called("displacement along y", "y", {"y_mm", "the same along y"})),
};
constexpr std::array kDriftNumbers{
    from<[](const Vec2& velocity) { return velocity.x(); }>(
        called("drift velocity along x", "v_x", {"drift_x_mm_s", "mean velocity of all rods along x"})),
    from<[](const Vec2& velocity) { return velocity.y(); }>(
        called("drift velocity along y", "v_y", {"drift_y_mm_s", "mean velocity of all rods along y"})),
};

std::unique_ptr<Measurement> measure_drift(const MeasureContext&) {
  const auto sample = [](const Sample& now, auto& drift) { drift.accumulate(now->time, now.unwrapped()); };
  const auto reduce = [](Reduction& result, const auto& drift) {
    put(result, "/drift/", kDriftSeries, drift);
    put(result, "", kDriftNumbers, drift.statistics());
  };
  return measured(sample, reduce, analysis::Drift());
}

}  // namespace

MeasurementKind drift_kind() {
  return {
      .name = "drift",
      .sources = "drift",
      .make = measure_drift,
      .arrays = outputs_of(kDriftSeries),
      .numbers = outputs_of(kDriftNumbers),
      .needs = {Needs::kIdentities, Needs::kEveryRod},
  };
}

}  // namespace shaken::run
