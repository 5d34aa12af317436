#include "bench/work.h"

#include <algorithm>

#include "base/clock.h"

namespace shaken::bench {
namespace {

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
             "with time\nleft and were deferred, and new bounds (of these: after a search, by beads, and too short to "
             "save "
             "the visit at the\nnext tick).\n",
             {per_rod_second("searches", "pairs_searched"), per_rod_second("touching", "pairs_touching"),
              ns("pairs_searched"), per_rod_second("deferred", "pairs_deferred"),
              per_rod_second("bounds", "pairs_bounded"), ns("pairs_bounded"),
              per_rod_second("when due", "bounds_when_due"), per_rod_second("by beads", "bounds_by_beads"),
              per_rod_second("no tick", "bounds_of_no_tick")}) +
         with(
             "\nHits, per rod and simulated second, each spent from the budgets of all pairs of the rod, and bounds "
             "that "
             "are\nshortened for that.\n",
             {per_rod_second("hits", "velocity_jumps"), ns("velocity_jumps"),
              per_rod_second("shortened", "bounds_shortened")});
}

}  // namespace shaken::bench
