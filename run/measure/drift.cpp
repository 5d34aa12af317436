// SPDX-License-Identifier: MIT
#include "analysis/drift.h"

#include <vector>

#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredDrift : public Measurement {
 public:
  void sample(const Sample& sample) override { drift_.accumulate(sample->time, sample.unwrapped()); }
  void reduce(Reduction& result) const override {
    const auto velocity =
        block_estimates(drift_.statistics(), result.t_steady, [](const analysis::DriftStatistics& part) {
          const Vec2 mean = part.reduce();
          return std::vector<double>{mean.x(), mean.y()};
        });
    result.arrays["/drift/time_s"] = drift_.times();
    result.arrays["/drift/x_mm"] = drift_.x();
    result.arrays["/drift/y_mm"] = drift_.y();
    result.scalars["drift_x_mm_s"] = velocity[0];
    result.scalars["drift_y_mm_s"] = velocity[1];
  }
  void save(StateWriter& writer) const override { drift_.save(writer); }
  void restore(StateReader& reader) override { drift_.restore(reader); }

 private:
  analysis::Drift drift_;
};

}  // namespace

MeasurementKind drift_kind() {
  return {
      .name = "drift",
      .sources = "drift",
      .make = [](const MeasureContext&) -> std::unique_ptr<Measurement> { return std::make_unique<MeasuredDrift>(); },
      .arrays =
          {
              {"time_s", "times; of more than 65,536 samples, each point is a mean of several"},
              {"x_mm", "displacement along x of the mean of all centres since the first sample"},
              {"y_mm", "the same along y"},
          },
      .numbers =
          {
              {"drift_x_mm_s", "mean velocity of all rods along x"},
              {"drift_y_mm_s", "mean velocity of all rods along y"},
          },
  };
}

}  // namespace shaken::run
