// SPDX-License-Identifier: MIT
// The scheduled stepper's cost against the number of rods, the step, and the number of threads.
#include <fmt/format.h>

#include "base/clock.h"
#include "bench/speed.h"

namespace shaken::bench {

Report scaling_report(const Conditions& conditions, Scaling of, const std::vector<Contender>& series) {
  const bool of_rods = of == Scaling::kRods;
  Report report = report_under(conditions, of_rods ? "scaling_n" : "scaling_dt", of_rods ? "scaling n" : "scaling dt");
  double before = 0;
  for (const Contender& point : series) {
    const double cost = series.front().speed.rate() / point.speed.rate();
    Json row = json_of(point.scene);
    row["scheduled"] = json_of(point.speed);
    row["relative_cost"] = cost;
    row["step_cost"] = before > 0 ? Json(cost / before) : Json();
    row["max_overlap_mm"] = point.speed.max_overlap;
    row["max_overlap_of_thickness"] = point.speed.max_overlap / point.scene.system().rod.mid_diameter;
    report.json["rows"].push_back(std::move(row));
    before = cost;
  }
  report.text += fmt::format(
      "\nCPU time per rod-second of the scheduled stepper against {}: relative to the first row (cost) and to\n"
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

double measure_serial_share(const Contender& of) {
  Simulation timed = resumed(of.scene, of.state, StepperKind::kScheduled);
  advance(timed, of.shorten_bound);
  timed.time_phases(thread_cpu_seconds_without_readings);
  const double start = thread_cpu_seconds_without_readings();
  advance(timed, of.ticks);
  const double all = thread_cpu_seconds_without_readings() - start;
  return 1 - timed.phase_times().in_loops() / all;
}

Report threads_report(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes) {
  Report report = report_under(conditions, "threads", "threads");
  for (const ThreadsSpeed& scene : scenes) {
    const Contender& first = scene.by.front();
    for (const Contender& of : scene.by) {
      Json row = json_of(of.scene);
      row["threads"] = of.threads;
      row["wall_s"] = of.speed.wall;
      row["cpu_s"] = of.speed.cpu;
      row["rod_s_per_wall_s"] = of.speed.rod_seconds / of.speed.best_wall();
      row["speed_up"] = first.speed.best_wall() / of.speed.best_wall();
      row["serial_share"] = scene.serial;
      row["limit"] = scene.limit(of.threads);
      row["relative_cpu"] = of.speed.best_cpu() / first.speed.best_cpu();
      row["spread"] = of.speed.wall_spread();
      row["state_hash"] = fmt::format("{:016x}", of.hash);
      row["hashes_equal"] = of.hash == first.hash;
      report.json["rows"].push_back(std::move(row));
    }
  }
  report.text +=
      "\nThe scheduled stepper by several threads: wall time (so other programs on the machine count) and CPU time of\n"
      "all threads, both relative to the first row of the scene; spread: median over best wall time; serial: share of\n"
      "one thread's CPU time that others cannot share; limit: the speed-up over one thread that this leaves.\n" +
      table(report.rows(), scene_columns({{"threads", "threads"},
                                          {"rod-s/wall-s", "rod_s_per_wall_s", "{:.1f}"},
                                          {"speed-up", "speed_up", "{:.2f}"},
                                          {"limit", "limit", "{:.2f}"},
                                          {"serial %", "serial_share", "{:.1f}", 100},
                                          {"CPU time", "relative_cpu", "{:.2f}"},
                                          {"spread", "spread", "{:.3f}"},
                                          {"same state", "hashes_equal"}}));
  return report;
}

}  // namespace shaken::bench
