// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/parts.h"
#include "analysis/time_series.h"
#include "bench/accuracy/averaged.h"
#include "bench/accuracy/errors.h"
#include "bench/timing.h"
#include "sim/rod/species.h"

namespace shaken::bench {
namespace {

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
  std::array<Estimate, kObservables.size()> means;
  double cpu_per_rod_second = 0;
  double max_overlap = 0;  ///< [mm]
  analysis::TiltCurve tilt;
};

Point measure_point(const StatisticsTask& task, double value, const Cache& cache) {
  Point point;
  std::array<std::vector<Estimate>, kObservables.size()> runs;
  std::vector<analysis::TiltVelocity> tilt;
  ObservableSeries series;
  for (int replica = 0; replica < task.replicas; ++replica) {
    const Case start = start_of(task, value, replica);
    Simulation simulation =
        continued(resumed(start, cache(start), StepperKind::kScheduled), scene_of(task, start, value));
    advance(simulation, std::llround(task.warm_up / simulation.world().system.dt));
    series = ObservableSeries();
    const std::string what = fmt::format("{}, {} {:.10g}, seed {}", start.label, task.knob->name, value, replica + 1);
    point.cpu_per_rod_second +=
        sample_every(ObservableSeries::kEvery, task.measure, what, simulation, [&] { series.sample(simulation); });
    for (std::size_t o = 0; o < kObservables.size(); ++o) {
      runs[o].push_back(mean_of_series(series.values(kObservables[o].name)));
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

}  // namespace

Estimate mean_of_runs(std::span<const Estimate> runs) {
  double sum = 0, squares = 0;
  for (const Estimate& run : runs) {
    sum += run.value;
    squares += run.sem * run.sem;
  }
  const auto n = static_cast<double>(runs.size());
  return {sum / n, std::sqrt(squares) / n};
}

Simulation continued(const Simulation& from, const System& scene) {
  const Snapshot rods = from.snapshot();
  World world = empty_world(scene);
  world.tick = std::llround(from.time() / scene.dt);
  for (std::size_t i = 0; i < rods.n_rods(); ++i) {
    Flight flight;
    flight.image = rods.image[i];
    begin_flight(flight, world.tick, {rods.position[i], rods.director[i]}, {rods.velocity[i], rods.angular_velocity[i]},
                 scene.box(), world.species[0].inertia_par / world.species[0].inertia_perp);
    world.rods.push_back(flight);
  }
  return Simulation::start_from(std::move(world));
}

Json measure_statistics(const StatisticsTask& task, const Cache& cache) {
  Json rows = Json::array(), tilt = Json::array();
  for (const double value : task.values) {
    const Point point = measure_point(task, value, cache);
    const Json series{{"length_mm", task.scene.length}, {"area_fraction", task.scene.area_fraction},
                      {"side_mm", task.scene.side},     {"n_rods", task.scene.n_rods()},
                      {"variant", task.variant->name},  {"knob", task.knob->name},
                      {"unit", task.knob->unit},        {"value", value}};
    rows.push_back(series);
    rows.back().update({{"simulated_s", task.replicas * task.measure},
                        {"cpu_s_per_rod_s", point.cpu_per_rod_second},
                        {"max_overlap_mm", point.max_overlap}});
    for (std::size_t o = 0; o < kObservables.size(); ++o) {
      rows.back()[kObservables[o].name] = {{"value", point.means[o].value}, {"sem", point.means[o].sem}};
    }
    tilt.push_back(series);
    tilt.back().update(
        {{"n_z", point.tilt.n_z}, {"v_along", point.tilt.v_along}, {"v_along_sem", point.tilt.v_along_sem}});
  }
  return {{"rows", rows}, {"tilt", tilt}};
}

Report statistics_report(const std::vector<Json>& measured) {
  Report report("statistical", "accuracy statistical");
  report.has_verdict = true;
  report.json["observables"] = Json::array();  // what figures need besides
  for (const Observable& info : kObservables) {
    report.json["observables"].push_back(
        {{"name", info.name}, {"unit", info.unit}, {"title", info.title}, {"has_limit", info.has_limit}});
  }
  report.json["tilt"] = Json::array();
  for (const Json& of : measured) {
    report.add(of.at("rows"));
    report.add(of.at("tilt"), "tilt");
  }
  return report;
}

}  // namespace shaken::bench
