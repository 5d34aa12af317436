// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <limits>
#include <memory>

#include "base/progress_line.h"
#include "bench/commands.h"
#include "bench/hard/made_cases.h"
#include "bench/hard/order_case.h"
#include "bench/hard/report.h"
#include "bench/hard/scene_cases.h"
#include "bench/options.h"
#include "bench/picture.h"
#include "bench/speed/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kFooter =
    R"(Runs what is numerically hard and tells how far each thing that must hold was from not
holding. Scenes are those of configs/hard; what is made by hand is bench/hard/made_cases.cpp.

Examples:
  shaken bench hard                              all cases, some ten minutes, nearly all of them for 'order'
  shaken bench hard needle row --json
  shaken bench hard --seconds 0.02               the scenes for 20 ms of their time, without 'order': a smoke test
  shaken bench hard --out hard                   hard/hard.csv, .json and .png

Exit codes: 0 all holds, 1 something does not hold, 2 bad input.)";

struct Words {
  std::vector<std::string> names;
  std::string folder = "configs/hard";
  std::string seconds;
  std::string out;
  bool json = false;
};

HardCase run_case(const std::string& name, const Words& words, double seconds) {
  ProgressLine progress(name);
  const Watch watch = [&](double fraction) { progress.show(fraction); };
  for (const MadeCase& made : made_cases()) {
    if (made.name == name) return made.run();
  }
  if (name == kOrderCase) return run_order_case(words.folder, {.seconds = seconds}, watch);
  for (const SceneCase& scene : scene_cases()) {
    if (scene.name == name) return run_scene_case(scene, read_hard_scene(words.folder, name), seconds, watch);
  }
  throw Failure(ExitCode::kFailed, name + " is not a case");
}

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const SceneCase& scene : scene_cases()) names.push_back(scene.name);
  names.emplace_back(kOrderCase);
  for (const MadeCase& made : made_cases()) names.push_back(made.name);
  return names;
}

ExitCode run(const Words& words) {
  OptionReader options;
  const std::vector<std::string> all = all_names();
  for (const std::string& name : words.names) {
    if (std::find(all.begin(), all.end(), name) == all.end()) {
      options.complain(fmt::format("'{}' is not a case; there are {}", name, fmt::join(all, ", ")));
    }
  }
  const double seconds = words.seconds.empty() ? std::numeric_limits<double>::infinity()
                                               : options.number("--seconds", words.seconds, 1e-4, 1e5);
  options.finish();

  std::vector<HardCase> cases;
  for (const std::string& name : words.names.empty() ? all : words.names) {
    // cut short it could only say that it does not know
    if (words.names.empty() && !words.seconds.empty() && name == kOrderCase) continue;
    cases.push_back(run_case(name, words, seconds));
  }
  const nlohmann::ordered_json json = as_json(cases);
  fmt::print("{}", words.json ? json.dump(2) + "\n" : as_text(cases));
  std::fflush(stdout);
  if (!words.out.empty()) {
    const std::filesystem::path folder = words.out;
    make_folder(folder);
    write_text(folder / "hard.json", json.dump(2) + "\n");
    write_text(folder / "hard.csv", as_csv(json.at("rows")));
    draw_margins(folder, cases);
  }
  const bool ok = std::all_of(cases.begin(), cases.end(), [](const HardCase& of) { return of.ok(); });
  return ok ? ExitCode::kOk : ExitCode::kFailed;
}

}  // namespace

void add_hard(CLI::App& app, Work& work) {
  const auto words = std::make_shared<Words>();
  CLI::App* hard = app.add_subcommand("hard", "What is numerically hard, and by what margin it goes well");
  hard->footer(kFooter);
  hard->add_option("CASE", words->names, "Cases; all if none is named");
  hard->add_option("--cases", words->folder, "Folder of the scenes")->type_name("DIR")->capture_default_str();
  hard->add_option("--seconds", words->seconds, "Simulated seconds of a scene, at most")->type_name("S");
  hard->add_option("-o,--out", words->out, "Also write CSV, JSON and PNG there")->type_name("DIR");
  hard->add_flag("--json", words->json, "Print JSON");
  hard->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
