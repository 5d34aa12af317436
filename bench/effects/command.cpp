// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "bench/case_words.h"
#include "bench/commands.h"
#include "bench/effects/report.h"
#include "bench/options.h"
#include "bench/picture.h"

namespace shaken::bench {
namespace {

constexpr const char* kFooter =
    R"(Every effect that can be off is switched off, one at a time (docs/effects.md). CPU times are compared from one and the same
state, which tells what it takes to compute the effect, and from a state that came about without it, which tells what a
user gains: mostly nothing, as rods without friction or bounce collide more often. States are kept in the cache.

Examples:
  shaken bench effects                                      527 rods of 4.5 mm at area fraction 0.75
  shaken bench effects --area-fraction 0.45 --out effects   fewer; effects/effects.csv, .json and .png
  shaken bench effects --warm-up 5 --repeat 9               in the steady state of each, with smaller errors

Exit codes: 0 done, 1 something failed, 2 bad input.)";

/// The options as the user wrote them; empty where nothing was said.
struct Words {
  CaseWords scene{41.865};
  std::string cpu, repeat, cache, out;
  bool json = false;
};

ExitCode run(const Words& words) {
  OptionReader options;
  Conditions conditions;
  conditions.machine = this_machine();
  conditions.effort.cpu = words.cpu.empty() ? 0.5 : options.number("--cpu", words.cpu, 1e-3, 1e3);
  conditions.effort.repeat = words.repeat.empty() ? 5 : options.whole("--repeat", words.repeat, 1, 1000);
  const auto scene = words.scene.read(options);
  options.finish();
  conditions.warm_up = scene->warm_up;

  const std::filesystem::path cache = words.cache.empty() ? default_cache() : std::filesystem::path(words.cache);
  const std::vector<Saving> savings = measure_savings(*scene, cache, conditions.effort);
  const nlohmann::ordered_json json = as_json(conditions, *scene, savings);
  fmt::print("{}", words.json ? json.dump(2) + "\n" : as_text(conditions, *scene, savings));
  std::fflush(stdout);
  if (words.out.empty()) return ExitCode::kOk;
  make_folder(words.out);
  write_text(std::filesystem::path(words.out) / "effects.json", json.dump(2) + "\n");
  write_text(std::filesystem::path(words.out) / "effects.csv", as_csv(json.at("rows")));
  draw_savings(words.out, savings);
  return ExitCode::kOk;
}

}  // namespace

void add_effects(CLI::App& app, Work& work) {
  const auto words = std::make_shared<Words>();
  CLI::App* effects = app.add_subcommand("effects", "CPU time that each effect of the physics costs");
  effects->footer(kFooter);
  const auto option = [&](const char* name, std::string& word, const char* type, const char* help) {
    effects->add_option(name, word, help)->type_name(type);
  };
  words->scene.declare(*effects);
  option("--cpu", words->cpu, "S", "CPU time of one timed stretch, about; 0.5");
  option("--repeat", words->repeat, "N", "Repetitions, of which the best counts; 5");
  option("--cache", words->cache, "DIR", "Where states after the warm-up are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "DIR", "Also write CSV, JSON and PNG there");
  effects->add_flag("--json", words->json, "Print JSON");
  effects->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
