// SPDX-License-Identifier: MIT
#include "bench/accuracy/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/parts.h"
#include "base/clock.h"
#include "base/progress_line.h"
#include "sim/rod/species.h"

namespace shaken::bench {
namespace {

/// The scene that the rods of one value start from, with its own steady state.
Case start_of(const StatisticsTask& task, double value, int replica) {
  Case start = task.scene;
  System& scene = start.plan.system;
  scene.seed = static_cast<std::uint64_t>(replica + 1);
  if (task.knob == Knob::kPitch) {
    scene.rod.n_beads = beads_for_pitch(scene.rod.length, scene.rod.end_diameter, value);
  }
  return start;
}

System scene_of(const StatisticsTask& task, const Case& start, double value) {
  System scene = start.system();
  task.variant->apply(scene);
  if (task.knob == Knob::kStep) scene.dt = 1e-6 * value;
  if (task.knob == Knob::kSweeps) scene.solver_sweeps = static_cast<int>(value);
  return scene;
}

/// Values of one replica.
struct Replica {
  std::array<Mean, kObservables> means;
  double cpu = 0;
};

Replica run(const StatisticsTask& task, double value, int replica, const Cache& cache, ObservableSeries& series,
            double& max_overlap) {
  const Case start = start_of(task, value, replica);
  const SteadyState state = cache(start);
  Simulation simulation = continued(resumed(start, state, Engine::kScheduled), scene_of(task, start, value));
  const double dt = simulation.world().system.dt;
  ProgressLine progress(fmt::format("{}, {} {:.10g}, seed {}", start.label(), kKnobNames[static_cast<int>(task.knob)],
                                    value, replica + 1));
  advance(simulation, std::llround(task.settle / dt));
  const Tick stride = std::llround(ObservableSeries::kEvery / dt);
  const int samples = std::max(1, static_cast<int>(task.measure / ObservableSeries::kEvery));
  Replica result;
  for (int k = 0; k < samples; ++k) {
    const double begun = cpu_seconds();
    advance(simulation, stride);
    result.cpu += cpu_seconds() - begun;
    series.sample(simulation);
    progress.show((k + 1.0) / samples);
  }
  for (int o = 0; o < kObservables; ++o) result.means[o] = mean_of(series.values(static_cast<Observable>(o)));
  max_overlap = std::max(max_overlap, simulation.world().counters.max_overlap());
  return result;
}

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

Statistics measure_statistics(const StatisticsTask& task, const Cache& cache) {
  Statistics statistics{task, {}, {}};
  for (const double value : task.values) {
    StatisticsPoint point;
    point.value = value;
    std::array<std::vector<Mean>, kObservables> replicas;
    std::optional<analysis::TiltVelocity> no_tilt;
    std::vector<analysis::TiltVelocity> tilt;
    double cpu = 0;
    for (int replica = 0; replica < task.replicas; ++replica) {
      ObservableSeries series;
      const Replica result = run(task, value, replica, cache, series, point.max_overlap);
      for (int o = 0; o < kObservables; ++o) replicas[o].push_back(result.means[o]);
      cpu += result.cpu;
      no_tilt = series.tilt().empty();
      for (analysis::TiltVelocity& part : series.tilt().parts_after(0.0, analysis::kMostParts)) {
        tilt.push_back(std::move(part));
      }
    }
    for (int o = 0; o < kObservables; ++o) point.means[o] = mean_of(replicas[o]);
    point.tilt = analysis::TiltVelocity::reduce(*no_tilt, tilt);
    point.cpu_per_rod_second = cpu / (task.scene.system().n_rods * task.measure * task.replicas);
    statistics.points.push_back(std::move(point));
  }

  for (int o = 0; o < kObservables; ++o) {
    Mean truth = statistics.points.front().means[o];
    std::vector<double> x;
    std::vector<Mean> means;
    for (const StatisticsPoint& point : statistics.points) {
      if (point.value > statistics.limit_step() || !(point.means[o].sem > 0)) continue;
      x.push_back(point.value);
      means.push_back(point.means[o]);
    }
    if (task.knob == Knob::kStep && kObservableInfo[o].has_limit && x.size() >= 2) {
      statistics.limits[o] = limit_of(x, means);
      truth = statistics.limits[o]->at_zero;
    }
    for (StatisticsPoint& point : statistics.points) point.biases[o] = relative_bias(point.means[o], truth);
    // the first value against itself is no measurement
    if (!statistics.limits[o]) statistics.points.front().biases[o] = {0, 0};
  }
  return statistics;
}

namespace {

const char* knob_of(const Statistics& of) { return kKnobNames[static_cast<std::size_t>(of.task.knob)]; }
const char* unit_of(const Statistics& of) { return kKnobUnits[static_cast<std::size_t>(of.task.knob)]; }

const char* verdict_text(Verdict verdict) {
  return verdict == Verdict::kBelow ? "below" : verdict == Verdict::kAbove ? "above" : "open";
}

Json mean_json(const Mean& mean) { return {{"value", mean.value}, {"sem", mean.sem}}; }

Json point_row(const Statistics& of, const StatisticsPoint& point) {
  Json row{{"length_mm", of.task.scene.length},
           {"area_fraction", of.task.scene.area_fraction},
           {"side_mm", of.task.scene.side},
           {"n_rods", of.task.scene.system().n_rods},
           {"variant", of.task.variant->name},
           {"knob", knob_of(of)},
           {"value", point.value},
           {"simulated_s", of.task.replicas * of.task.measure},
           {"cpu_s_per_rod_s", point.cpu_per_rod_second},
           {"max_overlap_mm", point.max_overlap}};
  for (int o = 0; o < kObservables; ++o) {
    Json& observable = row[kObservableInfo[o].name] = mean_json(point.means[o]);
    observable["bias"] = point.biases[o].value;
    observable["bias_error"] = point.biases[o].sem;
    observable["verdict"] = verdict_text(judge(point.biases[o], kBound));
  }
  return row;
}

std::string heading_of(const Statistics& of) {
  return fmt::format("\n{}, N = {}, {}: {}; {} x {:.10g} s of each, after {:.10g} s\n", of.task.scene.label(),
                     of.task.scene.system().n_rods, of.task.variant->name, knob_of(of), of.task.replicas,
                     of.task.measure, of.task.settle);
}

/// "T_xy: 8 us (16 us: open)" for every observable with a limit.
std::string steps_below_text(const Statistics& of) {
  std::string text;
  for (int o = 0; o < kObservables; ++o) {
    if (!of.limits[o]) continue;
    std::vector<Mean> biases;
    for (const StatisticsPoint& point : of.points) biases.push_back(point.biases[o]);
    const auto last = last_below(biases, kBound);
    const std::size_t next = last ? *last + 1 : 0;
    std::string found = last ? fmt::format("{:.10g} us", of.points[*last].value) : "none";
    if (next < biases.size()) {
      found += fmt::format(" ({:.10g} us: {})", of.points[next].value, verdict_text(judge(biases[next], kBound)));
    }
    text += fmt::format("  {}: {}\n", kObservableInfo[o].name, found);
  }
  return text;
}

/// The means of every value of the knob, and their biases.
std::string statistics_text(const Statistics& of, Json rows) {
  std::vector<Column> means{{fmt::format("{} {}", knob_of(of), unit_of(of)), "value", "{:.10g}"}};
  std::vector<Column> biases = means;
  means.push_back({"CPU-s/rod-s", "cpu_s_per_rod_s", "{:.3g}"});
  means.push_back({"overlap um", "max_overlap_mm", "{:.2f}", 1e3});
  for (const ObservableInfo& info : kObservableInfo) {
    const std::string name = info.name;
    means.push_back({fmt::format("{} {}", name, info.unit), name + "/value", "{:.4g} +- {:.1g}", 1, name + "/sem"});
    biases.push_back({name, name + "/bias", "{:.2f} +- {:.2f}", 100, name + "/bias_error"});
  }
  std::string text = heading_of(of) + table(rows, means);
  if (of.task.knob != Knob::kStep) return text + "Difference from the first row in %:\n" + table(rows, biases);
  Json quality{{"value", "chi2/f"}};
  for (int o = 0; o < kObservables; ++o) {
    const auto& limit = of.limits[o];
    if (!limit || limit->freedom == 0) continue;
    quality[kObservableInfo[o].name]["bias"] = fmt::format("{:.1f}", limit->chi_squared / limit->freedom);
  }
  rows.push_back(std::move(quality));
  text += fmt::format(
      "Bias in % of the limit dt -> 0, a line through the steps up to {:g} us (chi2 per degree of freedom below); of "
      "impulses, in % of the first row:\n",
      of.limit_step());
  text += table(rows, biases);
  return text +
         fmt::format(
             "Largest step up to which the bias is below {:g} % with two standard errors to spare (and the "
             "next step):\n",
             100 * kBound) +
         steps_below_text(of);
}

}  // namespace

Report statistics_report(const std::vector<Statistics>& measured) {
  Report report("statistical", "accuracy statistical");
  report.json["limits"] = Json::array();
  report.json["tilt"] = Json::array();
  for (const Statistics& of : measured) {
    Json rows = Json::array();
    const Json series{{"length_mm", of.task.scene.length}, {"variant", of.task.variant->name}};
    for (const StatisticsPoint& point : of.points) {
      rows.push_back(point_row(of, point));
      Json tilt = series;
      tilt.update({{"knob", knob_of(of)},
                   {"value", point.value},
                   {"n_z", point.tilt.n_z},
                   {"v_along", point.tilt.v_along},
                   {"v_along_sem", point.tilt.v_along_sem}});
      report.json["tilt"].push_back(std::move(tilt));
    }
    for (int o = 0; o < kObservables; ++o) {
      if (!of.limits[o]) continue;
      Json limit = series;
      limit.update({{"observable", kObservableInfo[o].name},
                    {"unit", kObservableInfo[o].unit},
                    {"limit", mean_json(of.limits[o]->at_zero)},
                    {"slope_per_us", mean_json(of.limits[o]->slope)},
                    {"chi_squared", of.limits[o]->chi_squared},
                    {"freedom", of.limits[o]->freedom}});
      report.json["limits"].push_back(std::move(limit));
    }
    report.text += statistics_text(of, rows);
    report.json["rows"].insert(report.json["rows"].end(), rows.begin(), rows.end());
  }
  return report;
}

}  // namespace shaken::bench
