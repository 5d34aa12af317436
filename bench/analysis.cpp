// SPDX-License-Identifier: MIT
// What each observable costs in a run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "bench/bench.h"
#include "bench/case.h"
#include "bench/report.h"
#include "run/measurements.h"
#include "scene/load.h"

namespace shaken::bench {
namespace {

constexpr const char* kAnalysisFooter =
    R"(What the observables cost: a stretch of a run at full size in which every observable is measured at its default period,
and the CPU time of each. A run pays for those only that its scene names.

Examples:
  shaken bench analysis                                     2,100 rods of 4.5 mm at area fraction 0.75
  shaken bench analysis --length 2.5 --area-fraction 0.65
  shaken bench analysis --side 33.5 --out analysis          a small box; analysis/analysis.csv and .json

Exit codes: 0 done, 1 something failed, 2 bad input.)";

/// One observable by itself.
struct Single {
  std::string name;          ///< block of the scene: measure.NAME
  double every = 0;          ///< [s]
  std::int64_t samples = 0;  ///< taken
  double cpu = 0;            ///< spent on them [s]
  std::unique_ptr<run::Measurements> measurements;
};

/// A stretch of a run, taken apart: CPU times of its parts [s].
struct AnalysisShares {
  double steps = 0;      ///< stepping
  double snapshots = 0;  ///< reading all rods at the ticks at which something is sampled
  std::vector<Single> observables;

  double analysis() const {
    double sum = snapshots;
    for (const Single& single : observables) sum += single.cpu;
    return sum;
  }
  double whole() const { return steps + analysis(); }
};

/// The case, with everything that can be measured switched on.
scene::RunPlan measuring_everything(const Case& scene) {
  Json measure = Json::object();
  for (const run::MeasurementKind& kind : run::measurement_kinds()) measure[std::string(kind.name)] = Json::object();
  const Json text{{"rods", {{"length", scene.length}, {"area_fraction", scene.area_fraction}}},
                  {"box", {{"side", scene.side}}},
                  {"measure", measure}};
  const scene::Loaded<scene::RunPlan> plan = scene::load_scene(text.dump(), "the scene");
  if (!plan) throw Failure(ExitCode::kFailed, to_string(plan.error()));
  return *plan;
}

std::vector<Single> singles_of(const scene::RunPlan& plan, const Species& species) {
  std::vector<Single> singles;
  for (const run::MeasurementKind& kind : run::measurement_kinds()) {
    const std::optional<double> every = kind.every(plan);
    if (!every) continue;
    singles.push_back(
        {std::string(kind.name), *every, 0, 0, std::make_unique<run::Measurements>(only(plan, kind), species)});
  }
  return singles;
}

/// Steps `simulation` for `sim_seconds` and takes every sample that `plan` asks for meanwhile, timing each observable.
AnalysisShares measure_analysis(const scene::RunPlan& plan, Simulation& simulation, double sim_seconds) {
  AnalysisShares shares;
  shares.observables = singles_of(plan, simulation.world().species.front());
  const Tick begin = simulation.tick();
  const Tick end = begin + std::llround(sim_seconds / plan.system.dt);
  for (Tick tick = begin; tick < end;) {
    Tick next = end;
    for (const Single& single : shares.observables) next = std::min(next, single.measurements->next_due(tick + 1));
    double mark = cpu_seconds();
    advance(simulation, next - tick);
    tick = next;
    double now = cpu_seconds();
    shares.steps += now - mark;
    mark = now;
    const Snapshot snapshot = simulation.snapshot();
    now = cpu_seconds();
    shares.snapshots += now - mark;
    for (Single& single : shares.observables) {
      if (single.measurements->next_due(tick) != tick) continue;
      mark = cpu_seconds();
      single.measurements->sample(snapshot);
      single.cpu += cpu_seconds() - mark;
      ++single.samples;
    }
  }
  return shares;
}

Report analysis_report(const Case& scene, const AnalysisShares& shares, double seconds) {
  Report report("analysis", "analysis");
  report.json.update({{"length_mm", scene.length},
                      {"area_fraction", scene.area_fraction},
                      {"side_mm", scene.side},
                      {"n_rods", scene.system().n_rods},
                      {"warm_up_s", scene.warm_up},
                      {"sim_s", seconds},
                      {"steps_cpu_s", shares.steps},
                      {"snapshots_cpu_s", shares.snapshots},
                      {"analysis_share", shares.analysis() / shares.whole()}});
  for (const Single& single : shares.observables) {
    report.json["rows"].push_back(
        {{"measure", single.name},
         {"every_s", single.every},
         {"samples", single.samples},
         {"cpu_s", single.cpu},
         {"sample_cpu_s", single.cpu / static_cast<double>(std::max<std::int64_t>(1, single.samples))},
         {"cpu_share", single.cpu / shares.whole()}});
  }
  Json shown = report.rows();
  std::sort(shown.begin(), shown.end(), [](const Json& a, const Json& b) { return a.at("cpu_s") > b.at("cpu_s"); });
  shown.push_back({{"measure", "(reading the rods)"}, {"cpu_share", shares.snapshots / shares.whole()}});
  shown.push_back({{"measure", "all analysis"}, {"cpu_share", shares.analysis() / shares.whole()}});
  report.text += fmt::format("{}, N = {}; {:.3g} s simulated after {:.3g} s, {:.3g} CPU-s of stepping\n\n",
                             scene.label(), scene.system().n_rods, seconds, scene.warm_up, shares.steps);
  report.text += table(shown, {{"measure", "measure"},
                               {"every ms", "every_s", "{:g}", 1e3},
                               {"samples", "samples"},
                               {"ms each", "sample_cpu_s", "{:.3g}", 1e3},
                               {"% of CPU", "cpu_share", "{:.2f}", 100}});
  return report;
}

struct AnalysisBench {
  CaseOptions scene{.side = 83.73};
  double seconds = 1;
  Cache cache;
  Output output;

  void declare(CLI::App& app) {
    scene.declare(app);
    add_number(app, "--seconds", seconds, "S", {1e-3, 1e4}, "Simulated seconds that are timed");
    cache.declare(app);
    output.declare(app, "CSV and JSON");
  }

  ExitCode run() const {
    const Case chosen = scene.read();
    Simulation simulation = resumed(chosen, cache(chosen), Engine::kScheduled);
    output.give(analysis_report(chosen, measure_analysis(measuring_everything(chosen), simulation, seconds), seconds));
    return ExitCode::kOk;
  }
};

}  // namespace

void add_analysis(CLI::App& app, Work& work) {
  add_bench<AnalysisBench>(app, work, "analysis", "CPU time that each observable costs in a run", kAnalysisFooter);
}

}  // namespace shaken::bench
