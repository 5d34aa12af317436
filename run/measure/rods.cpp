#include <string>

#include "analysis/rod_traces.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_rods(const MeasureContext& context) {
  const scene::MeasureRods& settings = *context.plan.rods;
  const auto sample = [](const Sample& now, auto& traces) {
    traces.accumulate(now->time, now.unwrapped(), now->director);
  };
  const auto reduce = [](Reduction& result, const auto& traces) {
    result.arrays["/rods/trace/time_s"] = traces.times();
    for (std::size_t k = 0; k < traces.traces().size(); ++k) {
      const analysis::RodTrace& trace = traces.traces()[k];
      const std::string path = "/rods/trace/" + std::to_string(k) + "/";
      result.arrays[path + "x_mm"] = trace.x;
      result.arrays[path + "y_mm"] = trace.y;
      result.arrays[path + "theta_rad"] = trace.theta;
      result.arrays[path + "n_z"] = trace.n_z;
    }
  };
  return measured(sample, reduce, analysis::RodTraces(settings.count, settings.duration));
}

}  // namespace

MeasurementKind rods_kind() {
  return {
      .name = "rods",
      .sources = "rod_traces",
      .make = measure_rods,
      .only_steady = true,
      .arrays =
          {
              {"trace/time_s", "times of the samples of single rods"},
              {"trace/K/x_mm", "path of rod K without jumps; one group for each rod that is followed"},
              {"trace/K/y_mm", "the same in y"},
              {"trace/K/theta_rad", "angle of its axis in the plane, in (-π, π]"},
              {"trace/K/n_z", "vertical component of its axis"},
          },
      .axes = {{"trace/K/", "trace/time_s"}},
      .needs = {Needs::kIdentities, Needs::kEveryRod},
  };
}

}  // namespace shaken::run
