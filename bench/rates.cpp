#include "bench/rates.h"

#include <fmt/format.h>

#include "base/failure.h"
#include "bench/kinds.h"

namespace shaken::bench {
namespace {

/// How a comparison is written.
struct Layout {
  const char* file;
  const char* bench;
  std::string words;
  std::vector<Column> columns;
};

const std::vector<Column> kScene{{"scene", "scene"}, {"N", "n_rods"}};
const Column kSpread{"spread", "scheduled/spread", "{:.3f}"}, kSame{"same state", "hashes_equal"};
const Column kPerImpulse{"ns/impulse", "scheduled/ns_per_impulse", "{:.0f}"};
const Column kMemory{"bytes/rod", "scheduled/bytes_per_rod", "{:.0f}"};

Layout of_steppers() {
  return {"speed",
          "speed",
          "Simulated rod-seconds per CPU-second by either stepper, in turn; spread is median over best CPU time of\n"
          "the scheduled and of the reference stepper; same state: bitwise, after as many ticks by either.",
          {{"scheduled", "scheduled/rod_s_per_cpu_s", "{:.1f}"},
           {"reference", "reference/rod_s_per_cpu_s", "{:.2f}"},
           {"ratio", "ratio", "{:.1f}"},
           kSpread,
           {"spread", "reference/spread", "{:.3f}"},
           {"impulses/CPU-s", "scheduled/impulses_per_cpu_s", "{:.3g}"},
           kPerImpulse,
           kMemory,
           kSame}};
}

Layout of_threads() {
  return {"threads",
          "threads",
          "The scheduled stepper by several threads: wall time (so other programs on the machine count) and CPU time "
          "of all\nthreads (cost), both relative to the first row of the scene; spread: median over best wall time; "
          "serial: share of one\nthread's CPU time that others cannot share; limit: the speed-up over one thread that "
          "this leaves.",
          {{"threads", "threads"},
           {"rod-s/wall-s", "scheduled/rod_s_per_wall_s", "{:.1f}"},
           {"speed-up", "speed_up", "{:.2f}"},
           {"limit", "limit", "{:.2f}"},
           {"serial %", "serial_share", "{:.1f}", 100},
           {"cost", "relative_cost", "{:.2f}"},
           {"spread", "scheduled/wall_spread", "{:.3f}"},
           kSame}};
}

/// The layout for scenes that take turns.
Layout of_series(const char* file, const char* bench, const std::string& by) {
  return {file,
          bench,
          fmt::format(
              "The scheduled stepper by {}.\nSpread: median over best CPU time; cost: CPU time per rod-second relative "
              "to the first line. Impulses from plates,\nfrom side walls and between rods are per rod and simulated "
              "second. Overlap: deepest since the start, in % of the\nrods' thickness.",
              by),
          {{"dt us", "dt_s", "{:.10g}", 1e6},
           {"rod-s/CPU-s", "scheduled/rod_s_per_cpu_s", "{:.1f}"},
           kSpread,
           {"cost", "relative_cost", "{:.3f}"},
           {"+-", "relative_cost_error", "{:.3f}"},
           {"plates", "scheduled/impulses_per_rod_second/plates", "{:.0f}"},
           {"walls", "scheduled/impulses_per_rod_second/walls", "{:.0f}"},
           {"rods", "scheduled/impulses_per_rod_second/rods", "{:.0f}"},
           kPerImpulse,
           kMemory,
           {"overlap %", "max_overlap_of_thickness", "{:.2f}", 100}}};
}

Layout layout_of(Comparison of) {
  if (of == Comparison::kThreads) return of_threads();
  if (of == Comparison::kRods) return of_series("scaling_n", "scaling n", "the number of rods");
  if (of == Comparison::kStep) return of_series("scaling_dt", "scaling dt", "the step");
  if (of == Comparison::kSteppers) return of_steppers();
  return of_series("kinds", "kinds",
                   fmt::format("kind of scene; bench/kinds.cpp says by what these differ from\n{}", kBaseKind));
}

}  // namespace

Json rate_row(const Contender& of, const Contender& first, const CountedWork& work) {
  Json row{{"scene", of.scene.label}};
  row.update(json_of(of.scene));
  row["scheduled"] = json_of(of.speed);
  const Estimate cost = cpu_ratio(of.speed, first.speed);
  row["relative_cost"] = cost.value;
  row["relative_cost_error"] = cost.sem;
  row["max_overlap_of_thickness"] = of.speed.max_overlap / of.scene.system().rod.mid_diameter;
  row.update(json_of(work));
  return row;
}

Json steppers_row(const Contender& scheduled, const Contender& reference, const CountedWork& work, Tick compared_ticks,
                  std::uint64_t scheduled_hash) {
  Json row = rate_row(scheduled, scheduled, work);
  row["reference"] = json_of(reference.speed);
  row["scheduled"]["state_hash"] = fmt::format("{:016x}", scheduled_hash);
  row["reference"]["state_hash"] = fmt::format("{:016x}", reference.hash);
  row["ratio"] = scheduled.speed.rate() / reference.speed.rate();
  row["compared_ticks"] = compared_ticks;
  row["hashes_equal"] = scheduled_hash == reference.hash;
  return row;
}

Json threads_row(const Contender& of, const Contender& first, const CountedWork& work) {
  Json row = rate_row(of, first, work);
  row["threads"] = of.threads;
  row["speed_up"] = first.speed.best_wall() / of.speed.best_wall();
  row["serial_share"] = work.serial_share();
  row["limit"] = 1 / (work.serial_share() + (1 - work.serial_share()) / of.threads);
  row["state_hash"] = fmt::format("{:016x}", of.hash);
  row["hashes_equal"] = of.hash == first.hash;
  return row;
}

Report rates_report(const Conditions& conditions, Comparison of, const Json& rows) {
  const Layout layout = layout_of(of);
  Report report(layout.file, layout.bench);
  report.json["warm_up_s"] = conditions.warm_up;
  report.json["steady"] = conditions.steady();
  report.json["repeat"] = conditions.effort.repeat;
  report.add(rows);
  std::vector<Column> columns = kScene;
  columns.insert(columns.end(), layout.columns.begin(), layout.columns.end());
  report.text += fmt::format(
      "state after {:.10g} simulated seconds{}; best of {} repetitions\n\n{}\n{}", conditions.warm_up,
      conditions.steady() ? "" : fmt::format(" (NOT the steady state: that takes {:.10g})", Conditions::kSteady),
      conditions.effort.repeat, layout.words, table(rows, columns));
  if (of != Comparison::kThreads) report.text += work_text(rows, {kScene.front()});
  return report;
}

void check_states(const Report& report, const std::string& what) {
  for (const Json& row : report.rows()) {
    if (row.at("hashes_equal").get<bool>()) continue;
    const Json& ticks = member_of(row, "compared_ticks");
    const std::string when = ticks.is_null() ? "" : fmt::format(" after {} ticks", ticks.get<Tick>());
    throw Failure(ExitCode::kFailed, fmt::format("{}: {}{}", text_of(row, "scene"), what, when));
  }
}

}  // namespace shaken::bench
