#include "bench/hard/hard.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/paths.h"
#include "base/progress_line.h"
#include "bench/bench.h"
#include "bench/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kHardFooter =
    R"(Runs what is numerically hard and tells how far each thing that must hold was from not
holding. Scenes are those of configs/hard; what is made by hand is bench/hard/made_cases.cpp.

Examples:
  shaken bench hard                              all cases: nine CPU-minutes for 'order', half of one for the others
  shaken bench hard needle row --json
  shaken bench hard order --replicas 60          a difference half as large can be told from none, in 36 minutes
  shaken bench hard --seconds 0.02               the scenes for 20 ms of their time, without 'order': a smoke test
  shaken bench hard --out hard                   hard/hard.csv, .json and .png
  shaken bench hard collapse --history 100       overlap, energy balance and S over 100 s, in 200 parts

Exit codes: 0 all holds, 1 something does not hold, 2 bad input.)";

Json hard_row(const HardCase& of, const Outcome& outcome) {
  const double margin = outcome.margin();
  return {{"case", of.name},
          {"what", of.what},
          {"holds", outcome.holds},
          {"worst", outcome.worst},
          {"limit", outcome.limit},
          {"limit_is", outcome.at_least ? "least" : "most"},
          {"margin", std::isfinite(margin) ? Json(margin) : Json(nullptr)},
          {"ok", outcome.ok()},
          {"note", outcome.note}};
}

Report hard_report(const std::vector<HardCase>& cases) {
  Report report("hard", "hard");
  std::string notes;
  for (const HardCase& of : cases) {
    for (const Outcome& outcome : of.outcomes) {
      report.json["rows"].push_back(hard_row(of, outcome));
      if (!outcome.ok()) notes += fmt::format("{}: {}: {}\n", of.name, outcome.holds, outcome.note);
    }
  }
  report.text += table(report.rows(), {{"case", "case"},
                                       {"what must hold", "holds"},
                                       {"worst", "worst", "{:.3g}"},
                                       {"at", "limit_is"},
                                       {"limit", "limit", "{:.3g}"},
                                       {"margin", "margin", "{:.2g}"},
                                       {"holds", "ok"}});
  report.text += notes;
  return report;
}

/// The histories of scenes, one row for each point.
struct Histories {
  Report report{"hard_history", "hard history"};

  void add(const std::string& name, const std::vector<HistoryPoint>& history) {
    for (const HistoryPoint& point : history) {
      report.json["rows"].push_back({{"case", name},
                                     {"time_s", point.time},
                                     {"S", point.order},
                                     {"kinetic_energy_pJ", point.kinetic_energy},
                                     {"max_overlap", point.overlap},
                                     {"energy_unaccounted", point.energy_error}});
    }
    report.text += fmt::format(
        "{}, after {:.10g} s: overlap {:.3g} of the thinnest bead's radius, energy unaccounted for "
        "{:.2g} of the turnover\n",
        name, history.back().time, history.back().overlap, history.back().energy_error);
  }
};

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const SceneCase& scene : scene_cases()) names.push_back(scene.name);
  names.emplace_back(kOrderCase);
  for (const MadeCase& made : made_cases()) names.push_back(made.name);
  return names;
}

struct HardBench {
  std::vector<std::string> names;
  std::string folder;
  std::optional<double> seconds;
  std::optional<double> history;  ///< [s]
  int replicas = OrderEffort{}.replicas;
  Output output;

  void declare(CLI::App& app) {
    app.add_option("CASE", names, "Cases; all if none is named")->check(CLI::IsMember(case_names()).description(""));
    add_path(app, "--cases", folder, "DIR", "Folder of the scenes; configs/hard, or that of the installed files");
    CLI::Option* shorter =
        add_number(app, "--seconds", seconds, "S", {1e-4, 1e5}, "Simulated seconds of a scene, at most");
    CLI::Option* followed =
        add_number(app, "--history", history, "S", {1e-2, 1e5},
                   "Follow the scenes for so many simulated seconds instead, and write what they do against time");
    CLI::Option* runs = app.add_option("--replicas", replicas, "Runs with each order of contacts in the case order");
    runs->check(CLI::Range(2, 10000))->capture_default_str();
    followed->excludes(shorter)->excludes(runs);
    output.declare(app);
  }

  std::filesystem::path scenes() const {
    if (!folder.empty()) return folder;
    return std::filesystem::exists("configs/hard") ? "configs/hard" : shipped_configs() / "hard";
  }

  HardCase run_case(const std::string& name) const {
    ProgressLine progress(name);
    const OnProgress on_progress = [&](double fraction) { progress.show(fraction); };
    const double at_most = seconds.value_or(std::numeric_limits<double>::infinity());
    for (const MadeCase& made : made_cases()) {
      if (made.name == name) return made.run();
    }
    for (const SceneCase& scene : scene_cases()) {
      if (scene.name == name) return run_scene_case(scene, read_hard_scene(scenes(), name), at_most, on_progress);
    }
    return run_order_case(scenes(), {.replicas = replicas, .seconds = at_most}, on_progress);
  }

  ExitCode follow() const {
    std::string problems;
    if (names.empty()) problems += "--history needs the name of at least one scene\n";
    for (const std::string& name : names) {
      if (std::ranges::none_of(scene_cases(), [&](const SceneCase& scene) { return scene.name == name; })) {
        problems += "--history is for scenes, which '" + name + "' is not\n";
      }
    }
    if (!problems.empty()) throw Failure(ExitCode::kBadInput, problems.substr(0, problems.size() - 1));
    Histories histories;
    for (const std::string& name : names) {
      const System scene = read_hard_scene(scenes(), name).system;
      ProgressLine progress(name);
      histories.add(name, history_of(scene, *history, [&](double fraction) { progress.show(fraction); }));
    }
    output.give(histories.report);
    return ExitCode::kOk;
  }

  ExitCode run() const {
    if (history) return follow();
    std::vector<HardCase> cases;
    for (const std::string& name : names.empty() ? case_names() : names) {
      // cut short it could only say that it does not know
      if (names.empty() && seconds && name == kOrderCase) continue;
      cases.push_back(run_case(name));
    }
    const Report report = hard_report(cases);
    output.give(report);
    const bool ok = std::all_of(cases.begin(), cases.end(), [](const HardCase& of) { return of.ok(); });
    return ok ? ExitCode::kOk : ExitCode::kFailed;
  }
};

}  // namespace

void add_hard(CLI::App& app, Work& work) {
  add_bench<HardBench>(app, work, "hard", "What is numerically hard, and by what margin it goes well", kHardFooter);
}

}  // namespace shaken::bench
