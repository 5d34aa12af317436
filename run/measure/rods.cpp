// SPDX-License-Identifier: MIT
#include <string>

#include "analysis/rod_traces.h"
#include "analysis/steady.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

class MeasuredRods : public Measurement {
 public:
  MeasuredRods(const scene::MeasureRods& rods, double from) : from_(from), traces_(rods.count, rods.duration) {}

  void sample(const Moment& moment) override {
    if (!analysis::is_steady(moment->time, from_)) return;
    traces_.accumulate(moment->time, moment.unwrapped(), moment->director);
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
  void save(analysis::StateWriter& writer) const override { traces_.save(writer); }
  void restore(analysis::StateReader& reader) override { traces_.restore(reader); }

 private:
  double from_;  ///< [s]
  analysis::RodTraces traces_;
};

}  // namespace

std::unique_ptr<Measurement> make_rods(const MeasureContext& context) {
  return std::make_unique<MeasuredRods>(*context.plan.rods, context.plan.steady.value_or(0.0));
}

}  // namespace shaken::run
