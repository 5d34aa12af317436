// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/table.h"
#include "bench/analysis/shares.h"
#include "bench/case_words.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/options.h"
#include "bench/picture.h"
#include "bench/steady_state.h"
#include "run/files/version.h"
#include "run/measure/registry.h"
#include "scene/load.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFooter =
    R"(What the observables cost: a stretch of a run at full size in which every observable is measured at its default period,
and the CPU time of each. A run pays for those only that its scene names.

Examples:
  shaken bench analysis                                     2,100 rods of 4.5 mm at area fraction 0.75
  shaken bench analysis --length 2.5 --area-fraction 0.65
  shaken bench analysis --side 33.5 --out analysis          a small box; analysis/analysis.json

Exit codes: 0 done, 1 something failed, 2 bad input.)";

struct Words {
  CaseWords scene{83.73};
  std::string seconds, cache, out;
  bool json = false;
};

/// The case, with everything that can be measured switched on.
scene::RunPlan measuring_everything(const Case& scene) {
  Json measure = Json::object();
  for (const run::MeasurementKind& kind : run::measurement_kinds()) measure[std::string(kind.name)] = Json::object();
  const Json text{{"rods", {{"length", scene.length}, {"area_fraction", scene.area_fraction}}},
                  {"box", {{"side", scene.side}}},
                  {"measure", measure}};
  const scene::Loaded<scene::RunPlan> plan = scene::load_scene(text.dump(), "the scene");
  if (!plan.value) throw Failure(ExitCode::kFailed, to_string(plan.problems));
  return *plan.value;
}

Json as_json(const Case& scene, const AnalysisShares& shares) {
  Json report{{"bench", "analysis"},
              {"version", run::version()},
              {"machine", to_json(this_machine())},
              {"length_mm", scene.length},
              {"area_fraction", scene.area_fraction},
              {"side_mm", scene.side},
              {"n_rods", scene.system().n_rods},
              {"warm_up_s", scene.warm_up},
              {"sim_s", shares.sim_seconds},
              {"steps_cpu_s", shares.cpu_steps},
              {"snapshots_cpu_s", shares.cpu_snapshots},
              {"analysis_share", shares.share()},
              {"rows", Json::array()}};
  for (const AnalysisCost& cost : shares.observables) {
    report["rows"].push_back(
        {{"measure", cost.name}, {"every_s", cost.every}, {"samples", cost.samples}, {"cpu_s", cost.cpu}});
  }
  return report;
}

std::string as_text(const Case& scene, const AnalysisShares& shares) {
  const double whole = shares.cpu_steps + shares.cpu_analysis();
  std::vector<Row> rows{{"measure", "every ms", "samples", "ms each", "% of CPU"}};
  const auto percent = [&](double cpu) { return fmt::format("{:.2f}", 100 * cpu / whole); };
  std::vector<AnalysisCost> costs = shares.observables;
  std::sort(costs.begin(), costs.end(), [](const auto& a, const auto& b) { return a.cpu > b.cpu; });
  for (const AnalysisCost& cost : costs) {
    rows.push_back(
        {cost.name, fmt::format("{:g}", 1e3 * cost.every), std::to_string(cost.samples),
         fmt::format("{:.3g}", 1e3 * cost.cpu / static_cast<double>(std::max<std::int64_t>(1, cost.samples))),
         percent(cost.cpu)});
  }
  rows.push_back({"(reading the rods)", "", "", "", percent(shares.cpu_snapshots)});
  rows.push_back({"all analysis", "", "", "", percent(shares.cpu_analysis())});
  return fmt::format("shaken {} on {}\n{}, N = {}; {:.3g} s simulated after {:.3g} s, {:.3g} CPU-s of stepping\n\n",
                     run::version(), describe(this_machine()), scene.label(), scene.system().n_rods, shares.sim_seconds,
                     scene.warm_up, shares.cpu_steps) +
         aligned(rows);
}

ExitCode run(const Words& words) {
  OptionReader options;
  const auto scene = words.scene.read(options);
  const double seconds = words.seconds.empty() ? 1.0 : options.number("--seconds", words.seconds, 1e-3, 1e4);
  options.finish();

  const std::filesystem::path cache = words.cache.empty() ? default_cache() : std::filesystem::path(words.cache);
  Simulation simulation = resumed(*scene, steady_state(*scene, cache), Engine::kScheduled);
  const AnalysisShares shares = measure_analysis(measuring_everything(*scene), simulation, seconds);
  const Json json = as_json(*scene, shares);
  fmt::print("{}", words.json ? json.dump(2) + "\n" : as_text(*scene, shares));
  std::fflush(stdout);
  if (!words.out.empty()) {
    make_folder(words.out);
    write_text(std::filesystem::path(words.out) / "analysis.json", json.dump(2) + "\n");
  }
  return ExitCode::kOk;
}

}  // namespace

void add_analysis(CLI::App& app, Work& work) {
  const auto words = std::make_shared<Words>();
  CLI::App* analysis = app.add_subcommand("analysis", "CPU time that each observable costs in a run");
  analysis->footer(kFooter);
  const auto option = [&](const char* name, std::string& word, const char* type, const char* help) {
    analysis->add_option(name, word, help)->type_name(type);
  };
  words->scene.declare(*analysis);
  option("--seconds", words->seconds, "S", "Simulated seconds that are timed; 1");
  option("--cache", words->cache, "DIR", "Where states after the warm-up are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "DIR", "Also write analysis.json there");
  analysis->add_flag("--json", words->json, "Print JSON");
  analysis->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
