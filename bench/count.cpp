// SPDX-License-Identifier: MIT
// What a rod-second consists of.
#include <fmt/format.h>

#include <algorithm>

#include "base/clock.h"
#include "bench/fits.h"
#include "bench/speed.h"

namespace shaken::bench {
namespace {

Json json_of(const BoundsInUse& bounds) {
  if (bounds.of_true_time.empty()) return nullptr;
  const double n = static_cast<double>(bounds.of_true_time.size());
  const Quartiles quartiles = quartiles_of(bounds.of_true_time);
  return {{"number", bounds.of_true_time.size()},
          {"median", quartiles.median},
          {"lower_quartile", quartiles.lower},
          {"of_no_tick_share", static_cast<double>(bounds.of_no_tick) / n}};
}

}  // namespace

CountedWork count_work(const Contender& of, Simulation& settled) {
  CountedWork counted;
  counted.of = of;
  settled.time_phases(thread_cpu_seconds_without_readings);
  const WorkCounts before = settled.work_counts();
  const double start = thread_cpu_seconds_without_readings();
  advance(settled, of.ticks);
  counted.cpu = thread_cpu_seconds_without_readings() - start;
  const WorkCounts after = settled.work_counts();
  for (std::size_t k = 0; k < kWorkKinds; ++k)
    counted.counts[k] = after.of(static_cast<WorkKind>(k)) - before.of(static_cast<WorkKind>(k));
  for (std::size_t p = 0; p < kPhases; ++p) counted.phases[p] = settled.phase_times().seconds(static_cast<Phase>(p));
  settled.time_phases(nullptr);
  return counted;
}

CountedWork measure_work(const Contender& of) {
  Simulation counting = resumed(of.scene, of.state, StepperKind::kScheduled);
  advance(counting, of.shorten_bound);
  CountedWork counted = count_work(of, counting);
  counted.bounds = measure_bounds(counting, of.scene.period_ticks());
  return counted;
}

void add_work(Json& row, const CountedWork& counted) {
  const double rod_seconds = counted.of.scene.rod_seconds(counted.of.ticks);
  for (std::size_t k = 0; k < kWorkKinds; ++k)
    row["per_rod_second"][kWorkNames[k]] = static_cast<double>(counted.counts[k]) / rod_seconds;
  const auto cost = [&](Phase phase, WorkKind work) {
    return 1e9 * counted.phases[static_cast<std::size_t>(phase)] /
           static_cast<double>(std::max<std::int64_t>(1, counted.counts[static_cast<std::size_t>(work)]));
  };
  row["ns"] = {{"rods_visited", cost(Phase::kSurfaces, WorkKind::kRodsVisited)},
               {"rods_bounded", cost(Phase::kRodBounds, WorkKind::kRodsBounded)},
               {"rods_placed", cost(Phase::kNeighbors, WorkKind::kRodsPlaced)},
               {"pairs_searched", cost(Phase::kDetection, WorkKind::kPairsSearched)},
               {"velocity_jumps", cost(Phase::kTightening, WorkKind::kVelocityJumps)},
               {"pairs_bounded", cost(Phase::kPairBounds, WorkKind::kPairsBounded)}};
}

std::string work_text(const Json& rows, const std::vector<Column>& scene) {
  const auto with = [&](const std::vector<Column>& more) {
    std::vector<Column> columns = scene;
    columns.insert(columns.end(), more.begin(), more.end());
    return table(rows, columns);
  };
  const auto counts = [](const char* title, const char* name) {
    return Column{title, std::string("per_rod_second/") + name, "{:.0f}"};
  };
  const auto ns = [](const char* name) { return Column{"ns", std::string("ns/") + name, "{:.0f}"}; };
  std::string text =
      "\nRods, per rod and simulated second, and the CPU time that each costs: visits for surfaces (of these: hit,\n"
      "and resting: to be visited at the next tick without a bound), bounds on the time to the next, and places in\n"
      "the neighbour list.\n" +
      with({counts("visits", "rods_visited"), counts("hit", "rods_hit"), counts("resting", "rods_resting"),
            ns("rods_visited"), counts("bounds", "rods_bounded"), ns("rods_bounded"), counts("places", "rods_placed"),
            ns("rods_placed")});
  text +=
      "\nPairs, per rod and simulated second: searches for contacts (of these: touching), pairs that came up with "
      "time\n"
      "left and waited on, and new bounds (of these: after a search, by beads, and too short to save the visit at the\n"
      "next tick).\n" +
      with({counts("searches", "pairs_searched"), counts("touching", "pairs_touching"), ns("pairs_searched"),
            counts("waited on", "pairs_deferred"), counts("bounds", "pairs_bounded"), ns("pairs_bounded"),
            counts("when due", "bounds_when_due"), counts("by beads", "bounds_by_beads"),
            counts("no tick", "bounds_of_no_tick")});
  return text +
         "\nChanges of motion, per rod and simulated second, of which all pairs of the rod are told, and bounds that "
         "are\ntightened for that.\n" +
         with({counts("told", "velocity_jumps"), ns("velocity_jumps"), counts("tightened", "bounds_shortened")});
}

Report count_report(const Conditions& conditions, const std::vector<CountedWork>& scenes) {
  Report report = report_under(conditions, "count", "count");
  for (const CountedWork& counted : scenes) {
    Json row = json_of(counted.of.scene);
    add_work(row, counted);
    row["hulls"] = json_of(counted.bounds.hulls);
    row["beads"] = json_of(counted.bounds.beads);
    report.json["rows"].push_back(std::move(row));
  }
  report.text += work_text(report.rows(), scene_columns({}));
  report.text +=
      "\nNew bounds of pairs that do not touch, over the time to contact in free flight (at most the schedule's\n"
      "horizon): median, lower quartile, and the share in % of those too short to save the visit at the next tick.\n" +
      table(report.rows(), scene_columns({{"hulls", "hulls/median", "{:.2f}"},
                                          {"quartile", "hulls/lower_quartile", "{:.2f}"},
                                          {"no tick %", "hulls/of_no_tick_share", "{:.1f}", 100},
                                          {"beads", "beads/median", "{:.2f}"},
                                          {"quartile", "beads/lower_quartile", "{:.2f}"},
                                          {"no tick %", "beads/of_no_tick_share", "{:.1f}", 100}}));
  return report;
}

}  // namespace shaken::bench
