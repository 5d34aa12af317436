#include "bench/rates.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/clock.h"
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

Column per_rod_second(const char* title, const char* name) {
  return {title, std::string("per_rod_second/") + name, "{:.0f}"};
}

Column ns(const char* name) { return {"ns", std::string("ns/") + name, "{:.0f}"}; }

std::vector<Column> phase_columns() {
  std::vector<Column> columns;
  for (const char* name : kPhaseNames) {
    std::string title = name;
    std::replace(title.begin(), title.end(), '_', ' ');
    columns.push_back({std::move(title), std::string("phase_shares/") + name, "{:.1f}", 100});
  }
  columns.push_back({"other", "phase_shares/other", "{:.1f}", 100});
  return columns;
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

CountedWork count_work(const Contender& of) {
  Simulation simulation = resumed(of.scene, of.state, StepperKind::kScheduled);
  advance(simulation, of.warm_up);
  CountedWork work;
  work.rod_seconds = of.scene.rod_seconds(of.ticks);
  const WorkCounts before = simulation.work_counts();
  simulation.time_phases(thread_cpu_seconds_without_readings);
  const double start = thread_cpu_seconds_without_readings();
  advance(simulation, of.ticks);
  work.cpu = thread_cpu_seconds_without_readings() - start;
  const WorkCounts after = simulation.work_counts();
  for (std::size_t k = 0; k < kWorkKinds; ++k) {
    work.counts[k] = after.of(static_cast<WorkKind>(k)) - before.of(static_cast<WorkKind>(k));
  }
  for (std::size_t p = 0; p < kPhases; ++p) work.phases[p] = simulation.phase_times().seconds(static_cast<Phase>(p));
  work.in_loops = simulation.phase_times().in_loops();
  return work;
}

Json json_of(const CountedWork& work) {
  Json row;
  for (std::size_t k = 0; k < kWorkKinds; ++k) {
    row["per_rod_second"][kWorkNames[k]] = static_cast<double>(work.counts[k]) / work.rod_seconds;
  }
  const auto cost = [&](Phase phase, WorkKind kind) {
    return 1e9 * work.phases[static_cast<std::size_t>(phase)] /
           static_cast<double>(std::max<std::int64_t>(1, work.counts[static_cast<std::size_t>(kind)]));
  };
  row["ns"] = {{"rods_visited", cost(Phase::kSurfaces, WorkKind::kRodsVisited)},
               {"rods_bounded", cost(Phase::kRodBounds, WorkKind::kRodsBounded)},
               {"rods_placed", cost(Phase::kNeighbors, WorkKind::kRodsPlaced)},
               {"pairs_searched", cost(Phase::kDetection, WorkKind::kPairsSearched)},
               {"velocity_jumps", cost(Phase::kShortening, WorkKind::kVelocityJumps)},
               {"pairs_bounded", cost(Phase::kPairBounds, WorkKind::kPairsBounded)}};
  double other = 1;
  for (std::size_t p = 0; p < kPhases; ++p) {
    const double share = work.phases[p] / work.cpu;
    row["phase_shares"][kPhaseNames[p]] = share;
    other -= share;
  }
  row["phase_shares"]["other"] = std::max(0.0, other);  // < 0: the clock's error
  return row;
}

std::string work_text(const Json& rows, const std::vector<Column>& scene) {
  const auto with = [&](const char* title, const std::vector<Column>& more) {
    std::vector<Column> columns = scene;
    columns.insert(columns.end(), more.begin(), more.end());
    return title + table(rows, columns);
  };
  return with(
             "\nWhere the scheduled stepper's CPU time goes, in % (from a run of its own, without the clock's time).\n",
             phase_columns()) +
         with(
             "\nRods, per rod and simulated second, and the CPU time that each costs: visits for surfaces (of these: "
             "hit,\nand polled: to be visited at the next tick without a bound), bounds on the time to the next, and "
             "places in\nthe neighbour list.\n",
             {per_rod_second("visits", "rods_visited"), per_rod_second("hit", "rods_hit"),
              per_rod_second("polled", "rods_polled"), ns("rods_visited"), per_rod_second("bounds", "rods_bounded"),
              ns("rods_bounded"), per_rod_second("places", "rods_placed"), ns("rods_placed")}) +
         with(
             "\nPairs, per rod and simulated second: searches for contacts (of these: touching), pairs that came up "
             "while their\nbounds held and were not searched, and new bounds (of these: of pairs that came up, by "
             "beads, "
             "and too short to\nsave the visit at the next tick).\n",
             {per_rod_second("searches", "pairs_searched"), per_rod_second("touching", "pairs_touching"),
              ns("pairs_searched"), per_rod_second("apart", "pairs_apart"), per_rod_second("bounds", "pairs_bounded"),
              ns("pairs_bounded"), per_rod_second("when due", "bounds_when_due"),
              per_rod_second("by beads", "bounds_by_beads"), per_rod_second("no tick", "bounds_of_no_tick")}) +
         with(
             "\nHits, per rod and simulated second, each spent from the budgets of all pairs of the rod, and bounds "
             "that are\nshortened for that.\n",
             {per_rod_second("hits", "velocity_jumps"), ns("velocity_jumps"),
              per_rod_second("shortened", "bounds_shortened")});
}

}  // namespace shaken::bench
