// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/parts.h"
#include "analysis/time_series.h"
#include "base/estimate.h"
#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/observables.h"
#include "bench/fits.h"
#include "bench/timing.h"
#include "sim/rod/species.h"

namespace shaken::bench {
namespace {

/// Where the bias of an observable is settled.
constexpr double kBound = 0.01;

/// The scene that the rods of one value start from, with its own steady state.
Case start_of(const StatisticsTask& task, double value, int replica) {
  Case start = task.scene;
  System& scene = start.plan.system;
  scene.seed = static_cast<std::uint64_t>(replica + 1);
  if (task.knob == &kPitchKnob) {
    scene.rod.n_beads = beads_for_pitch(scene.rod.length, scene.rod.end_diameter, value);
  }
  return start;
}

System scene_of(const StatisticsTask& task, const Case& start, double value) {
  System scene = start.system();
  task.variant->apply(scene);
  if (task.knob == &kStepKnob) scene.dt = 1e-6 * value;
  if (task.knob == &kSweepsKnob) scene.solver_sweeps = static_cast<int>(value);
  return scene;
}

/// Over all of one run's samples, with the error from their autocorrelation.
Estimate mean_of_series(const std::vector<double>& values) {
  if (values.empty()) return {0, 0};
  const auto n = static_cast<double>(values.size());
  const double variance = std::pow(mean_of_samples(values).sem, 2) * (n - 1);
  return {analysis::mean_of(values), std::sqrt(variance * analysis::statistical_inefficiency(values) / n)};
}

/// What was measured at one value of the knob.
struct Point {
  std::array<Estimate, kObservables> means;
  double cpu_per_rod_second = 0;
  double max_overlap = 0;  ///< [mm]
  analysis::TiltCurve tilt;
};

Point measure_point(const StatisticsTask& task, double value, const Cache& cache) {
  Point point;
  std::array<std::vector<Estimate>, kObservables> runs;
  std::vector<analysis::TiltVelocity> tilt;
  ObservableSeries series;
  for (int replica = 0; replica < task.replicas; ++replica) {
    const Case start = start_of(task, value, replica);
    Simulation simulation =
        continued(resumed(start, cache(start), StepperKind::kScheduled), scene_of(task, start, value));
    advance(simulation, std::llround(task.shorten_bound / simulation.world().system.dt));
    series = ObservableSeries();
    const std::string what = fmt::format("{}, {} {:.10g}, seed {}", start.label, task.knob->name, value, replica + 1);
    point.cpu_per_rod_second +=
        sample_every(ObservableSeries::kEvery, task.measure, what, simulation, [&] { series.sample(simulation); });
    for (std::size_t o = 0; o < kObservables; ++o) {
      runs[o].push_back(mean_of_series(series.values(static_cast<Observable>(o))));
    }
    const auto parts = series.tilt().parts_after(0.0, analysis::kMostParts);
    tilt.insert(tilt.end(), parts.begin(), parts.end());
    point.max_overlap = std::max(point.max_overlap, simulation.world().counters.max_overlap());
  }
  std::transform(runs.begin(), runs.end(), point.means.begin(), mean_of_runs);
  point.tilt = analysis::TiltVelocity::reduce(series.tilt().empty(), tilt);
  point.cpu_per_rod_second /= task.scene.system().n_rods * task.measure * task.replicas;
  return point;
}

/// The limit dt -> 0 of one observable, if it has one and the points tell.
std::optional<Limit> limit_of_steps(const StatisticsTask& task, const std::vector<Point>& points, std::size_t o) {
  if (task.knob != &kStepKnob || !kObservableInfo[o].has_limit) return std::nullopt;
  std::vector<double> x;
  std::vector<Estimate> means;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (task.values[k] > kLinear * task.values.front() || !(points[k].means[o].sem > 0)) continue;
    x.push_back(task.values[k]);
    means.push_back(points[k].means[o]);
  }
  if (x.size() < 2) return std::nullopt;
  return limit_of(x, means);
}

Json mean_json(const Estimate& mean) { return {{"value", mean.value}, {"sem", mean.sem}}; }

}  // namespace

Simulation continued(const Simulation& from, const System& scene) {
  const Snapshot rods = from.snapshot();
  World world = empty_world(scene);
  world.tick = std::llround(from.time() / scene.dt);
  for (std::size_t i = 0; i < rods.n_rods(); ++i) {
    Flight flight;
    flight.image = rods.image[i];
    begin_flight(flight, world.tick, {rods.position[i], rods.director[i]}, {rods.velocity[i], rods.angular_velocity[i]},
                 scene.box_side, world.species[0].inertia_par / world.species[0].inertia_perp);
    world.rods.push_back(flight);
  }
  return Simulation::start_from(std::move(world));
}

Json measure_statistics(const StatisticsTask& task, const Cache& cache) {
  const Json series{{"length_mm", task.scene.length}, {"variant", task.variant->name}};
  std::vector<Point> points;
  Json rows = Json::array(), limits = Json::array(), tilt = Json::array();
  for (const double value : task.values) {
    const Point& point = points.emplace_back(measure_point(task, value, cache));
    rows.push_back({{"length_mm", task.scene.length},
                    {"area_fraction", task.scene.area_fraction},
                    {"side_mm", task.scene.side},
                    {"n_rods", task.scene.system().n_rods},
                    {"variant", task.variant->name},
                    {"knob", task.knob->name},
                    {"value", value},
                    {"simulated_s", task.replicas * task.measure},
                    {"cpu_s_per_rod_s", point.cpu_per_rod_second},
                    {"max_overlap_mm", point.max_overlap}});
    tilt.push_back(series);
    tilt.back().update({{"knob", task.knob->name},
                        {"value", value},
                        {"n_z", point.tilt.n_z},
                        {"v_along", point.tilt.v_along},
                        {"v_along_sem", point.tilt.v_along_sem}});
  }
  for (std::size_t o = 0; o < kObservables; ++o) {
    const ObservableInfo& info = kObservableInfo[o];
    const std::optional<Limit> limit = limit_of_steps(task, points, o);
    if (limit) {
      limits.push_back(series);
      limits.back().update({{"observable", info.name},
                            {"unit", info.unit},
                            {"limit", mean_json(limit->at_zero)},
                            {"slope_per_us", mean_json(limit->slope)},
                            {"chi_squared", limit->chi_squared},
                            {"freedom", limit->freedom}});
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Estimate& mean = points[k].means[o];
      Estimate bias = relative_bias(mean, limit ? limit->at_zero : points.front().means[o]);
      if (k == 0 && !limit) bias = {0, 0};  // the first value against itself is no measurement
      rows[k][info.name] = mean_json(mean);
      rows[k][info.name].update({{"bias", bias.value}, {"bias_error", bias.sem}, {"verdict", verdict(bias, kBound)}});
    }
  }
  return {{"rows", rows}, {"limits", limits}, {"tilt", tilt}};
}

namespace {

/// "T_xy: 8 us (16 us: open)" for every observable with a limit.
std::string steps_below_text(const Json& rows, const Json& limits) {
  std::string text;
  for (const Json& limit : limits) {
    const std::string name = text_of(limit, "observable");
    const auto next =
        std::find_if(rows.begin(), rows.end(), [&](const Json& row) { return row.at(name).at("verdict") != "below"; });
    const auto step = [](const Json& row) { return fmt::format("{:.10g} us", row.at("value").get<double>()); };
    text += fmt::format("  {}: {}", name, next == rows.begin() ? "none" : step(*std::prev(next)));
    if (next != rows.end()) text += fmt::format(" ({}: {})", step(*next), text_of(next->at(name), "verdict"));
    text += "\n";
  }
  return text;
}

/// The means of every value of the knob, and their biases.
std::string statistics_text(const StatisticsTask& task, Json rows, const Json& limits) {
  std::vector<Column> means{{fmt::format("{} {}", task.knob->name, task.knob->unit), "value", "{:.10g}"}};
  std::vector<Column> biases = means;
  means.push_back({"CPU-s/rod-s", "cpu_s_per_rod_s", "{:.3g}"});
  means.push_back({"overlap um", "max_overlap_mm", "{:.2f}", 1e3});
  for (const ObservableInfo& info : kObservableInfo) {
    const std::string name = info.name;
    means.push_back({fmt::format("{} {}", name, info.unit), name + "/value", "{:.4g} +- {:.1g}", 1, name + "/sem"});
    biases.push_back({name, name + "/bias", "{:.2f} +- {:.2f}", 100, name + "/bias_error"});
  }
  std::string text = fmt::format("\n{}, N = {}, {}: {}; {} x {:.10g} s of each, after {:.10g} s\n", task.scene.label,
                                 task.scene.system().n_rods, task.variant->name, task.knob->name, task.replicas,
                                 task.measure, task.shorten_bound) +
                     table(rows, means);
  if (task.knob != &kStepKnob) return text + "Difference from the first row in %:\n" + table(rows, biases);
  const std::string below = steps_below_text(rows, limits);
  Json quality{{"value", "chi2/f"}};
  for (const Json& limit : limits) {
    const int freedom = limit.at("freedom");
    if (freedom == 0) continue;
    quality[text_of(limit, "observable")]["bias"] =
        fmt::format("{:.1f}", limit.at("chi_squared").get<double>() / freedom);
  }
  rows.push_back(std::move(quality));
  return text +
         fmt::format(
             "Bias in % of the limit dt -> 0, a line through the steps up to {:g} us (chi2 per degree of freedom "
             "below); "
             "of impulses, in % of the first row:\n",
             kLinear * task.values.front()) +
         table(rows, biases) +
         fmt::format(
             "Largest step up to which the bias is below {:g} % with two standard errors to spare (and the next "
             "step):\n",
             100 * kBound) +
         below;
}

}  // namespace

Report statistics_report(const std::vector<StatisticsTask>& tasks, const std::vector<Json>& measured) {
  Report report("statistical", "accuracy statistical");
  // what figures need besides
  report.json["linear"] = kLinear;
  report.json["observables"] = Json::array();
  for (const ObservableInfo& info : kObservableInfo) {
    report.json["observables"].push_back(
        {{"name", info.name}, {"unit", info.unit}, {"title", info.title}, {"has_limit", info.has_limit}});
  }
  report.json["limits"] = Json::array();
  report.json["tilt"] = Json::array();
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    report.add(measured[k].at("rows"));
    report.add(measured[k].at("limits"), "limits");
    report.add(measured[k].at("tilt"), "tilt");
    report.text += statistics_text(tasks[k], measured[k].at("rows"), measured[k].at("limits"));
  }
  return report;
}

}  // namespace shaken::bench
