// SPDX-License-Identifier: MIT
#include "bench/analysis/shares.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/failure.h"
#include "run/measurements.h"

namespace shaken::bench {
namespace {

/// One measurement by itself.
struct Single {
  AnalysisCost cost;
  std::unique_ptr<run::Measurements> measurements;
};

std::vector<Single> singles_of(const scene::RunPlan& plan, const Species& species) {
  std::vector<Single> singles;
  for (const run::MeasurementKind& kind : run::measurement_kinds()) {
    const std::optional<double> every = kind.every(plan);
    if (!every) continue;
    Single& single = singles.emplace_back();
    single.cost.name = kind.name;
    single.cost.every = *every;
    single.measurements = std::make_unique<run::Measurements>(only(plan, kind), species);
  }
  return singles;
}

}  // namespace

double AnalysisShares::cpu_analysis() const {
  double sum = cpu_snapshots;
  for (const AnalysisCost& cost : observables) sum += cost.cpu;
  return sum;
}

double AnalysisShares::share() const { return cpu_analysis() / (cpu_analysis() + cpu_steps); }

AnalysisShares measure_analysis(const scene::RunPlan& plan, Simulation& simulation, double sim_seconds) {
  std::vector<Single> singles = singles_of(plan, simulation.world().species.front());
  AnalysisShares shares;
  const Tick begin = simulation.tick();
  const Tick end = begin + std::llround(sim_seconds / plan.system.dt);
  for (Tick tick = begin; tick < end;) {
    Tick next = end;
    for (const Single& single : singles) next = std::min(next, single.measurements->next_due(tick + 1));
    double mark = cpu_seconds();
    if (simulation.advance_to(next)) throw Failure(ExitCode::kFailed, "numerical trouble");
    tick = next;
    double now = cpu_seconds();
    shares.cpu_steps += now - mark;
    mark = now;
    const Snapshot snapshot = simulation.snapshot();
    now = cpu_seconds();
    shares.cpu_snapshots += now - mark;
    for (Single& single : singles) {
      if (single.measurements->next_due(tick) != tick) continue;
      mark = cpu_seconds();
      single.measurements->sample(snapshot);
      single.cost.cpu += cpu_seconds() - mark;
      ++single.cost.samples;
    }
  }
  shares.sim_seconds = static_cast<double>(end - begin) * plan.system.dt;
  for (Single& single : singles) shares.observables.push_back(std::move(single.cost));
  return shares;
}

}  // namespace shaken::bench
