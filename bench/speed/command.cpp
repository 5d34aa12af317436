// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "bench/commands.h"
#include "bench/options.h"
#include "bench/picture.h"
#include "bench/speed/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kFooter = R"(A steady state is simulated once (progress on stderr) and kept in the cache.

Examples:
  shaken bench speed                                    rods of 4.5 and 2.5 mm in a box of 41.865 mm
  shaken bench speed --quick                            about a minute, not yet in the steady state
  shaken bench speed --full --out speed                 24 scenes; speed/speed.csv, .json and .png
  shaken bench speed --length 4.5,2.5 --area-fraction 0.75 --side 83.73
  shaken bench speed --scaling n --out speed            cost per rod from 500 to 18,000 rods
  shaken bench speed --scaling dt                       cost of a finer step
  shaken bench speed --threads 1,2,4 --area-fraction 0.75 --side 83.73

Exit codes: 0 done, 1 the engines' states differ or something failed, 2 bad input.)";

constexpr double kDefaultStep = 4e-6;  // [s]; the paper's
constexpr double kSmallSide = 41.865;  // [mm]; half the paper's box
constexpr double kQuickWarmUp = 0.5;   // [s]
constexpr double kScalingFraction = 0.75;
const std::vector<double> kLengths{4.5, 2.5};
const std::vector<double> kFractions{0.45, 0.60, 0.75, 0.85};
const std::vector<double> kSides{41.865, 83.73, 167.46};
const std::vector<double> kScalingSides{41.865, 83.73, 167.46, 244};
const std::vector<double> kScalingSteps{8e-6, 4e-6, 2e-6, 1e-6};

/// The options as the user wrote them; empty where nothing was said.
struct Words {
  std::string lengths, fractions, sides, warm_up, cpu, repeat, threads, scaling, cache, out;
  bool full = false, quick = false, json = false;
};

/// What to measure.
struct Task {
  std::vector<Case> scenes;
  std::vector<int> threads;
  std::optional<Scaling::Of> scaling;
  Conditions conditions;
  std::filesystem::path cache;
};

std::vector<Case> asked_scenes(const Words& words, std::optional<Scaling::Of> scaling, double warm_up,
                               OptionReader& options) {
  const bool lists = !words.lengths.empty() || !words.fractions.empty() || !words.sides.empty();
  const auto list = [&](const char* option, const std::string& text, const char* field,
                        const std::vector<double>& otherwise) {
    const auto& [low, high] = limits_of(field);
    return text.empty() ? otherwise : options.numbers(option, text, low, high);
  };
  const std::vector<double> lengths =
      list("--length", words.lengths, "rods.length", words.full ? kLengths : std::vector{4.5});
  const std::vector<double> fractions = list("--area-fraction", words.fractions, "rods.area_fraction", kFractions);
  const std::vector<double> sides =
      list("--side", words.sides, "box.side", words.full ? kSides : std::vector{kSmallSide});
  if (lengths.empty() || fractions.empty() || sides.empty()) return {};  // every value was refused

  std::vector<Case> scenes;
  const auto add = [&](double length, double fraction, double side, double dt) {
    if (const auto scene = make_case(length, fraction, side, dt, warm_up, options)) scenes.push_back(*scene);
  };
  if (scaling == Scaling::Of::kRods) {
    for (const double side : words.sides.empty() ? kScalingSides : sides) {
      add(lengths.front(), words.fractions.empty() ? kScalingFraction : fractions.front(), side, kDefaultStep);
    }
    return scenes;
  }
  if (scaling == Scaling::Of::kStep) {
    for (const double dt : kScalingSteps) {
      add(lengths.front(), words.fractions.empty() ? kScalingFraction : fractions.front(), sides.front(), dt);
    }
    return scenes;
  }
  for (const double side : sides) {
    for (const double length : lengths) {
      for (const double fraction : fractions) add(length, fraction, side, kDefaultStep);
    }
  }
  if (!lists && !words.full) add(2.5, 0.60, kSmallSide, kDefaultStep);
  return scenes;
}

Task read(const Words& words) {
  OptionReader options;
  Task task;
  if (words.scaling == "n") task.scaling = Scaling::Of::kRods;
  if (words.scaling == "dt") task.scaling = Scaling::Of::kStep;
  const bool scaling = task.scaling.has_value();
  if (!scaling && !words.scaling.empty()) {
    options.complain(fmt::format("--scaling: '{}' is neither n nor dt", words.scaling));
  }
  if (scaling && !words.threads.empty()) options.complain("--scaling and --threads are two benches; choose one");
  if (words.full && words.quick) options.complain("--full and --quick contradict each other");
  if (words.full && scaling) options.complain("--full has no meaning with --scaling");
  const auto at_most_one = [&](const char* option, const std::string& text) {
    if (scaling && text.find(',') != std::string::npos) {
      options.complain(fmt::format("{}: --scaling {} takes one value, not '{}'", option, words.scaling, text));
    }
  };
  at_most_one("--length", words.lengths);
  at_most_one("--area-fraction", words.fractions);
  if (task.scaling == Scaling::Of::kStep) at_most_one("--side", words.sides);

  const auto number = [&](const char* option, const std::string& text, double low, double high, double otherwise) {
    return text.empty() ? otherwise : options.number(option, text, low, high);
  };
  const bool brief = words.quick || scaling;
  Conditions& conditions = task.conditions;
  conditions.machine = this_machine();
  conditions.warm_up = number("--warm-up", words.warm_up, 1e-3, 1e4, brief ? kQuickWarmUp : Conditions::kSteady);
  conditions.effort.cpu = number("--cpu", words.cpu, 1e-3, 1e3, words.quick ? 0.5 : 1.5);
  conditions.effort.repeat =
      words.repeat.empty() ? (words.quick ? 3 : 5) : options.whole("--repeat", words.repeat, 1, 1000);
  if (!words.threads.empty()) task.threads = options.wholes("--threads", words.threads, 1, 1024);
  task.cache = words.cache.empty() ? default_cache() : std::filesystem::path(words.cache);
  task.scenes = asked_scenes(words, task.scaling, conditions.warm_up, options);
  options.finish();
  return task;
}

/// Gives the report to the terminal and, if wished, to files.
template <class Report>
void deliver(const Words& words, const std::string& name, const Conditions& conditions, const Report& report) {
  const nlohmann::ordered_json json = as_json(conditions, report);
  fmt::print("{}", words.json ? json.dump(2) + "\n" : as_text(conditions, report));
  std::fflush(stdout);
  if (words.out.empty()) return;
  const std::filesystem::path folder = words.out;
  make_folder(folder);
  write_text(folder / (name + ".json"), json.dump(2) + "\n");
  write_text(folder / (name + ".csv"), as_csv(json.at("rows")));
}

ExitCode run_scaling(const Task& task, const Words& words) {
  std::vector<SteadyState> states;
  for (const Case& scene : task.scenes) states.push_back(steady_state(scene, task.cache));
  const Scaling scaling = measure_scaling(*task.scaling, task.scenes, states, task.conditions.effort);
  deliver(words, task.scaling == Scaling::Of::kRods ? "scaling_n" : "scaling_dt", task.conditions, scaling);
  if (!words.out.empty()) draw_scaling(words.out, scaling);
  return ExitCode::kOk;
}

ExitCode run_threads(const Task& task, const Words& words) {
  std::vector<ThreadsSpeed> measured;
  for (const Case& scene : task.scenes) {
    measured.push_back(measure_threads(scene, steady_state(scene, task.cache), task.threads, task.conditions.effort));
  }
  deliver(words, "threads", task.conditions, measured);
  for (const ThreadsSpeed& scene : measured) {
    if (!scene.hashes_equal()) {
      throw Failure(ExitCode::kFailed, scene.scene.label() + ": the number of threads changed the trajectory");
    }
  }
  return ExitCode::kOk;
}

ExitCode run_scenes(const Task& task, const Words& words) {
  std::vector<SceneSpeed> measured;
  for (const Case& scene : task.scenes) {
    measured.push_back(measure_scene(scene, steady_state(scene, task.cache), task.conditions.effort));
  }
  deliver(words, "speed", task.conditions, measured);
  if (!words.out.empty()) draw_scenes(words.out, measured);
  for (const SceneSpeed& scene : measured) {
    if (!scene.hashes_equal()) {
      throw Failure(ExitCode::kFailed, fmt::format("{}: the engines' states differ after {} ticks", scene.scene.label(),
                                                   scene.compared_ticks));
    }
  }
  return ExitCode::kOk;
}

}  // namespace

void add_speed(CLI::App& app, Work& work) {
  const auto words = std::make_shared<Words>();
  CLI::App* speed = app.add_subcommand("speed", "Simulated rod-seconds per CPU-second, and what they are spent on");
  speed->footer(kFooter);
  const auto option = [&](const char* name, std::string& word, const char* type, const char* help) {
    speed->add_option(name, word, help)->type_name(type);
  };
  option("--length", words->lengths, "LIST", "Rod lengths [mm]");
  option("--area-fraction", words->fractions, "LIST", "Area fractions");
  option("--side", words->sides, "LIST", "Sides of the box [mm]");
  speed->add_flag("--full", words->full,
                  "All 24 scenes: 2 lengths, 4 area fractions, 3 boxes (an hour the first time)");
  speed->add_flag("--quick", words->quick, "Shorter warm-up and stretches: about a minute");
  option("--warm-up", words->warm_up, "S", "Simulated seconds before measuring; 5, or 0.5 with --quick and --scaling");
  option("--cpu", words->cpu, "S", "CPU time of one timed stretch, about; 1.5, or 0.5 with --quick");
  option("--repeat", words->repeat, "N", "Repetitions, of which the best counts; 5, or 3 with --quick");
  option("--scaling", words->scaling, "n|dt", "Instead: cost per rod against the number of rods, or the step");
  option("--threads", words->threads, "LIST", "Instead: wall time by so many threads");
  option("--cache", words->cache, "DIR", "Where steady states are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "DIR", "Also write CSV, JSON and PNG there");
  speed->add_flag("--json", words->json, "Print JSON");
  speed->callback([words, &work] {
    work = [words] {
      const Task task = read(*words);
      if (task.scaling) return run_scaling(task, *words);
      return task.threads.empty() ? run_scenes(task, *words) : run_threads(task, *words);
    };
  });
}

}  // namespace shaken::bench
