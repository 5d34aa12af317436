// SPDX-License-Identifier: MIT
// The scheduled engine's cost against the number of rods, the step, and the number of threads.
#include <fmt/format.h>

#include <algorithm>

#include "base/progress_line.h"
#include "bench/speed.h"

namespace shaken::bench {

std::vector<ScalingPoint> measure_scaling(const std::vector<Case>& scenes, const Cache& cache, const Effort& effort) {
  std::vector<SteadyState> states;
  states.reserve(scenes.size());
  for (const Case& scene : scenes) states.push_back(cache(scene));
  std::vector<ScalingPoint> points;
  std::vector<Tick> ticks;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    points.push_back({scenes[k], {}});
    ticks.push_back(
        std::max(ticks_for(effort.cpu, scenes[k], states[k], Engine::kScheduled), scenes[k].period_ticks()));
  }
  ProgressLine progress("measuring");
  double done = 0;
  for (int repetition = 0; repetition < effort.repeat; ++repetition) {
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      Simulation simulation = resumed(scenes[k], states[k], Engine::kScheduled);
      advance(simulation, scenes[k].period_ticks());
      time_stretch(simulation, scenes[k], ticks[k], points[k].speed);
      progress.show(++done / static_cast<double>(effort.repeat * static_cast<int>(scenes.size())));
    }
  }
  return points;
}

Report scaling_report(const Conditions& conditions, Scaling of, const std::vector<ScalingPoint>& points) {
  const bool of_rods = of == Scaling::kRods;
  Report report = report_under(conditions, of_rods ? "scaling_n" : "scaling_dt", of_rods ? "scaling n" : "scaling dt");
  const auto cost = [](const ScalingPoint& point) { return 1 / point.speed.rate(); };
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [scene, speed] = points[k];
    Json row = json_of(scene);
    row["scheduled"] = json_of(speed);
    row["relative_cost"] = cost(points[k]) / cost(points.front());
    row["step_cost"] = k > 0 ? Json(cost(points[k]) / cost(points[k - 1])) : Json();
    row["max_overlap_mm"] = speed.max_overlap;
    row["max_overlap_of_thickness"] = speed.max_overlap / scene.system().rod.mid_diameter;
    report.json["rows"].push_back(std::move(row));
  }
  report.text += fmt::format(
      "\nCPU time per rod-second of the scheduled engine against {}: relative to the first row (cost) and to\n"
      "the row before (step cost). Overlap: deepest since the start, in % of the rods' thickness.\n",
      of_rods ? "the number of rods" : "the step");
  report.text += table(report.rows(), scene_columns({{"dt us", "dt_s", "{:.10g}", 1e6},
                                                     {"rod-s/CPU-s", "scheduled/rod_s_per_cpu_s", "{:.1f}"},
                                                     {"spread", "scheduled/spread", "{:.3f}"},
                                                     {"cost", "relative_cost", "{:.3f}"},
                                                     {"step cost", "step_cost", "{:.3f}"},
                                                     {"bytes/rod", "scheduled/bytes_per_rod", "{:.0f}"},
                                                     {"max overlap %", "max_overlap_of_thickness", "{:.2f}", 100}}));
  return report;
}

void draw_scaling(const std::filesystem::path& folder, Scaling of, const Report& report) {
  const bool of_rods = of == Scaling::kRods;
  Figure figure;
  figure.name = report.name;
  figure.x_title = of_rods ? "number of rods N" : "step {/Symbol D}t (μs)";
  figure.y_title =
      fmt::format("CPU time per rod-second, relative to {}", of_rods ? "the smallest N" : "the longest step");
  figure.style = Figure::Style::kLinesPoints;
  figure.commands = {of_rods ? "set logscale x" : "set logscale x 2", "set yrange [0:*]",
                     "set offsets graph 0.05, graph 0.05, graph 0.1, 0"};
  const Column x = of_rods ? Column{"", "n_rods"} : Column{"", "dt_s", "", 1e6};
  figure.curves.push_back(curve(report.rows(), x, {"scheduled", "relative_cost"}));
  // what an engine whose ticks all cost the same would take
  Curve guide{.label = of_rods ? "cost of a rod independent of N" : "cost of a step independent of its length",
              .colour = 1,
              .x = figure.curves.front().x,
              .look = Curve::Look::kDashes};
  for (const double place : guide.x) guide.y.push_back(of_rods ? 1 : guide.x.front() / place);
  figure.curves.push_back(std::move(guide));
  draw(figure, folder);
}

bool ThreadsSpeed::hashes_equal() const {
  return std::all_of(points.begin(), points.end(),
                     [&](const ThreadsPoint& point) { return point.hash == points.front().hash; });
}

ThreadsSpeed measure_threads(const Case& scene, const SteadyState& state, const std::vector<int>& threads,
                             const Effort& effort) {
  ThreadsSpeed result{scene, {}};
  for (const int n : threads) result.points.push_back({n, {}, 0});
  const Tick ticks = std::max(ticks_for(effort.cpu, scene, state, Engine::kScheduled), scene.period_ticks());
  ProgressLine progress("measuring threads on " + scene.label());
  double done = 0;
  for (int repetition = 0; repetition < effort.repeat; ++repetition) {
    for (ThreadsPoint& point : result.points) {
      Simulation simulation = resumed(scene, state, Engine::kScheduled);
      simulation.use_threads(point.threads);
      advance(simulation, scene.period_ticks());
      time_stretch(simulation, scene, ticks, point.speed);
      point.hash = simulation.state_hash();
      progress.show(++done / static_cast<double>(effort.repeat * static_cast<int>(threads.size())));
    }
  }
  return result;
}

Report threads_report(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes) {
  Report report = report_under(conditions, "threads", "threads");
  for (const ThreadsSpeed& scene : scenes) {
    const ThreadsPoint& first = scene.points.front();
    for (const auto& [threads, speed, hash] : scene.points) {
      Json row = json_of(scene.scene);
      row["threads"] = threads;
      row["wall_s"] = speed.wall;
      row["cpu_s"] = speed.cpu;
      row["rod_s_per_wall_s"] = speed.rod_seconds / speed.best_wall();
      row["speed_up"] = first.speed.best_wall() / speed.best_wall();
      row["relative_cpu"] = speed.best_cpu() / first.speed.best_cpu();
      row["spread"] = speed.wall_spread();
      row["state_hash"] = fmt::format("{:016x}", hash);
      row["hashes_equal"] = hash == first.hash;
      report.json["rows"].push_back(std::move(row));
    }
  }
  report.text +=
      "\nThe scheduled engine by several threads: wall time (so other programs on the machine count) and CPU time of\n"
      "all threads, both relative to the first row of the scene; spread: median over best wall time.\n" +
      table(report.rows(), scene_columns({{"threads", "threads"},
                                          {"rod-s/wall-s", "rod_s_per_wall_s", "{:.1f}"},
                                          {"speed-up", "speed_up", "{:.2f}"},
                                          {"CPU time", "relative_cpu", "{:.2f}"},
                                          {"spread", "spread", "{:.3f}"},
                                          {"same state", "hashes_equal"}}));
  return report;
}

}  // namespace shaken::bench
