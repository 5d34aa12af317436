// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

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
  std::string length, fraction, side, warm_up, cpu, repeat, cache, out;
  bool json = false;
};

ExitCode run(const Words& words) {
  OptionReader options;
  const auto number = [&](const char* option, const std::string& text, double low, double high, double otherwise) {
    return text.empty() ? otherwise : options.number(option, text, low, high);
  };
  const auto quantity = [&](const char* option, const std::string& text, const char* field, double otherwise) {
    const auto& [low, high] = limits_of(field);
    return number(option, text, low, high, otherwise);
  };
  Conditions conditions;
  conditions.machine = this_machine();
  conditions.warm_up = number("--warm-up", words.warm_up, 1e-3, 1e4, 0.5);
  conditions.effort.cpu = number("--cpu", words.cpu, 1e-3, 1e3, 0.5);
  conditions.effort.repeat = words.repeat.empty() ? 5 : options.whole("--repeat", words.repeat, 1, 1000);
  const double length = quantity("--length", words.length, "rods.length", 4.5);
  const double fraction = quantity("--area-fraction", words.fraction, "rods.area_fraction", 0.75);
  const double side = quantity("--side", words.side, "box.side", 41.865);
  options.finish();
  const auto scene = make_case(length, fraction, side, 4e-6, conditions.warm_up, options);
  options.finish();

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
  option("--length", words->length, "MM", "Rod length [mm]; 4.5");
  option("--area-fraction", words->fraction, "PHI", "Area fraction; 0.75");
  option("--side", words->side, "MM", "Side of the box [mm]; 41.865");
  option("--warm-up", words->warm_up, "S", "Simulated seconds of each scene before it is timed; 0.5");
  option("--cpu", words->cpu, "S", "CPU time of one timed stretch, about; 0.5");
  option("--repeat", words->repeat, "N", "Repetitions, of which the best counts; 5");
  option("--cache", words->cache, "DIR", "Where states after the warm-up are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "DIR", "Also write CSV, JSON and PNG there");
  effects->add_flag("--json", words->json, "Print JSON");
  effects->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
