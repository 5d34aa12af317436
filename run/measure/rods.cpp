// SPDX-License-Identifier: MIT
#include <string>

#include "analysis/rod_traces.h"
#include "analysis/steady.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredRods : public Measurement {
 public:
  MeasuredRods(const scene::MeasureRods& rods, double from) : from_(from), traces_(rods.count, rods.duration) {}

  void sample(const Sample& sample) override {
    if (!analysis::is_steady(sample->time, from_)) return;
    traces_.accumulate(sample->time, sample.unwrapped(), sample->director);
  }
  void reduce(Reduction& result) const override {
    result.arrays["/rods/trace/time_s"] = traces_.times();
    for (std::size_t k = 0; k < traces_.traces().size(); ++k) {
      const analysis::RodTrace& trace = traces_.traces()[k];
      const std::string path = "/rods/trace/" + std::to_string(k) + "/";
      result.arrays[path + "x_mm"] = trace.x;
      result.arrays[path + "y_mm"] = trace.y;
      result.arrays[path + "theta_rad"] = trace.theta;
      result.arrays[path + "n_z"] = trace.n_z;
    }
  }
  void save(StateWriter& writer) const override { traces_.save(writer); }
  void restore(StateReader& reader) override { traces_.restore(reader); }

 private:
  double from_;  ///< [s]
  analysis::RodTraces traces_;
};

}  // namespace

MeasurementKind rods_kind() {
  return {
      .name = "rods",
      .sources = "rod_traces",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredRods>(*context.plan.rods, context.plan.steady.value_or(0.0));
      },
      .arrays =
          {
              {"trace/time_s", "times of the samples of single rods"},
              {"trace/K/x_mm", "path of rod K without jumps; one group for each rod that is followed"},
              {"trace/K/y_mm", "the same in y"},
              {"trace/K/theta_rad", "angle of its axis in the plane, in (-π, π]"},
              {"trace/K/n_z", "vertical component of its axis"},
          },
  };
}

}  // namespace shaken::run
