// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "analysis/order.h"
#include "analysis/time_series.h"
#include "bench/accuracy/errors.h"
#include "bench/timing.h"

namespace shaken::bench {
namespace {

constexpr double kEvery = 0.005;  ///< between samples of S [s]; one vibration

}  // namespace

Json measure_order_error(const Case& scene, double measure, int replicas, const Cache& cache) {
  Json series = Json::array();
  std::vector<double> means;
  double cpu = 0, tau = 0, measured = 0;
  for (int replica = 0; replica < replicas; ++replica) {
    Case start = scene;
    start.plan.system.seed = static_cast<std::uint64_t>(replica + 1);
    Simulation simulation = resumed(start, cache(start), StepperKind::kScheduled);
    std::vector<double> values;
    cpu += sample_every(kEvery, measure, fmt::format("S(t) of {}, seed {}", scene.label, replica + 1), simulation,
                        [&] { values.push_back(analysis::nematic_order(simulation.snapshot().director).order); });
    measured = kEvery * static_cast<double>(values.size());
    tau += kEvery * (0.5 + analysis::autocorrelation_time(values)) / replicas;
    means.push_back(mean_of_samples(values).value);
    series.push_back(values);
  }
  const Json row{{"side_mm", scene.side}, {"n_rods", scene.n_rods()},
                 {"replicas", replicas},  {"measured_s", measured},
                 {"every_s", kEvery},     {"mean", mean_of_samples(means).value},
                 {"tau_s", tau},          {"cpu_s_per_rod_s", cpu / (scene.n_rods() * measured * replicas)}};
  return {{"row", row}, {"series", series}};
}

Report order_error_report(const std::vector<Json>& measured, const Case& paper_box) {
  Report report("error", "accuracy error");
  report.has_verdict = true;
  report.json["paper_box"] = {{"side_mm", paper_box.side}, {"n_rods", paper_box.n_rods()}};
  for (const Json& of : measured) {
    report.json["rows"].push_back(of.at("row"));
    report.json["series"].push_back(of.at("series"));
  }
  return report;
}

}  // namespace shaken::bench
