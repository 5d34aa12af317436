// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "bench/accuracy/convergence.h"
#include "bench/accuracy/order_error.h"
#include "bench/accuracy/report.h"
#include "bench/accuracy/statistics.h"
#include "bench/commands.h"
#include "bench/options.h"
#include "bench/picture.h"
#include "bench/speed/report.h"
#include "bench/steady_state.h"

namespace shaken::bench {
namespace {

constexpr const char* kFooter = R"(Parts:
  deterministic  errors of a few rods against converged solutions, and their order
  statistical    bias of temperatures, order, drift, displacements with step, bead pitch and sweeps
  error          how the statistical error of S falls with simulated time, and what it costs
  (none)         all of them: about 40 minutes of CPU time, a quarter of that with --quick

Examples:
  shaken bench accuracy --quick
  shaken bench accuracy deterministic --out accuracy     convergence.png, work_precision.png, CSV, JSON
  shaken bench accuracy deterministic --cases head-on,wedged --steps 64,32,16,8,4,2,1
  shaken bench accuracy statistical --out accuracy       bias.png, tilt.png, model.png, CSV, JSON
  shaken bench accuracy statistical --knobs step --variants newton,instant --measure 200 --replicas 4
  shaken bench accuracy error --sides 15,20,30,40 --measure 100 --out accuracy

Exit codes: 0 done, 1 the steppers' states differ or something failed, 2 bad input.)";

const std::vector<std::string> kParts{"deterministic", "statistical", "error"};

/// The options as the user wrote them; empty where nothing was said.
struct Words {
  std::string part, cases, variants, knobs, steps, members, side, sides, measure, warm_up, replicas, cache, out;
  bool quick = false, full = false, json = false;
};

struct Task {
  std::vector<std::string> parts;
  std::vector<const StartCase*> cases;
  std::vector<const Variant*> variants;
  ConvergenceEffort convergence;
  std::vector<StatisticsTask> statistics;
  std::vector<std::pair<Case, double>> orders;  ///< boxes, and the time to be measured in each [s]
  std::optional<Case> paper;                    ///< whose cost is extrapolated
  int replicas = 1;
  std::filesystem::path cache;
};

constexpr double kPaperStep = 4e-6;                                   // [s]
constexpr double kPaperSide = 83.73;                                  // [mm]
const std::vector<double> kStatisticalSteps{1, 2, 4, 8, 16, 32, 64};  // [us]

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> parts(1);
  for (const char c : words) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// kLongestStep / 2^k, finest first, down to `finest` [s].
std::vector<double> halved_steps(double finest) {
  std::vector<double> steps;
  for (double dt = kLongestStep; dt > 0.9 * finest; dt /= 2) steps.insert(steps.begin(), dt);
  return steps;
}

std::vector<double> asked_steps(const std::string& words, OptionReader& options) {
  std::vector<double> steps;
  for (const double us : options.numbers("--steps", words, 1.0 / 64, 1e6 * kLongestStep)) {
    const double halvings = std::log2(1e6 * kLongestStep / us);
    if (halvings != std::round(halvings)) {
      options.complain(fmt::format("--steps: {:.10g} is not 64 us halved some times", us));
    }
    steps.push_back(1e-6 * us);
  }
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  return steps;
}

/// Those of `all` that `words` names; all of them if it is empty.
template <class Named>
std::vector<const Named*> asked_of(const std::vector<Named>& all, const std::string& option, const std::string& words,
                                   OptionReader& options) {
  std::vector<const Named*> asked;
  if (words.empty()) {
    for (const Named& one : all) asked.push_back(&one);
    return asked;
  }
  for (const std::string& name : split(words)) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
    if (found != all.end()) {
      asked.push_back(&*found);
      continue;
    }
    std::string known;
    for (const Named& one : all) known += (known.empty() ? "" : ", ") + std::string(one.name);
    options.complain(fmt::format("{}: '{}' is not one of {}", option, name, known));
  }
  return asked;
}

/// What the knobs are turned in: the paper's dense rods, and shorter ones that drift.
void ask_statistics(const Words& words, double warm_up, Task& task, OptionReader& options) {
  const double effort = words.quick ? 0.2 : words.full ? 4 : 1;
  const auto& [low, high] = limits_of("box.side");
  std::vector<double> steps = kStatisticalSteps;
  if (!words.steps.empty()) {
    steps.clear();
    for (const double dt : asked_steps(words.steps, options)) steps.push_back(1e6 * dt);
  }
  const auto add = [&](double length, double fraction, double side, Knob knob, std::vector<double> values,
                       double measure) {
    if (!words.side.empty()) side = options.number("--side", words.side, low, high);
    if (!words.measure.empty()) measure = options.number("--measure", words.measure, 0.01, 1e6);
    const auto scene = make_case(length, fraction, side, kPaperStep, warm_up, options);
    if (!scene) return;
    for (const Variant* variant : task.variants) {
      if (words.variants.empty() && variant != &variants().front()) continue;
      task.statistics.push_back({*scene, variant, knob, values, measure, std::min(1.0, warm_up), task.replicas});
    }
  };
  for (const std::string& knob : split(words.knobs.empty() ? "step,pitch,sweeps" : words.knobs)) {
    if (knob == "step") {
      add(4.5, 0.75, 25, Knob::kStep, steps, 30 * effort);
      add(2.5, 0.60, 20, Knob::kStep, steps, 50 * effort);
    } else if (knob == "pitch") {
      add(4.5, 0.75, 25, Knob::kPitch, {0.15, 0.2, 0.3, 0.45, 0.6}, 15 * effort);
    } else if (knob == "sweeps") {
      add(4.5, 0.75, 25, Knob::kSweeps, {8, 4, 2, 1}, 15 * effort);
    } else {
      options.complain(fmt::format("--knobs: '{}' is not one of step, pitch, sweeps", knob));
    }
  }
}

void ask_orders(const Words& words, double warm_up, Task& task, OptionReader& options) {
  const double effort = words.quick ? 0.2 : words.full ? 4 : 1;
  const auto& [low, high] = limits_of("box.side");
  // with two replicas about a hundred correlation times of S, a second each
  std::vector<std::pair<double, double>> boxes{{15, 80}, {21, 80}, {30, 60}, {42, 40}};
  if (!words.sides.empty()) {
    boxes.clear();
    for (const double side : options.numbers("--sides", words.sides, low, high)) boxes.emplace_back(side, 50);
    std::sort(boxes.begin(), boxes.end());
  }
  for (auto [side, measure] : boxes) {
    measure *= effort;
    if (!words.measure.empty()) measure = options.number("--measure", words.measure, 0.1, 1e6);
    if (const auto scene = make_case(4.5, 0.75, side, kPaperStep, warm_up, options))
      task.orders.emplace_back(*scene, measure);
  }
  task.paper = make_case(4.5, 0.75, kPaperSide, kPaperStep, warm_up, options);
}

Task read(const Words& words) {
  OptionReader options;
  Task task;
  task.parts = kParts;
  if (!words.part.empty()) {
    if (std::find(kParts.begin(), kParts.end(), words.part) == kParts.end()) {
      options.complain(fmt::format("'{}' is not a part: {}", words.part, fmt::join(kParts, ", ")));
    }
    task.parts = {words.part};
  }
  if (words.quick && words.full) options.complain("--full and --quick contradict each other");
  task.cases = asked_of(start_cases(), "--cases", words.cases, options);
  task.variants = asked_of(variants(), "--variants", words.variants, options);
  task.convergence.steps =
      words.steps.empty() ? halved_steps(words.quick ? 1e-6 : 0.25e-6) : asked_steps(words.steps, options);
  if (words.quick) task.convergence.members = 16;
  if (words.full) task.convergence.converged_by = 128;
  if (!words.members.empty()) task.convergence.members = options.whole("--members", words.members, 1, 100'000);
  const auto asked = [&](const char* part) {
    return std::find(task.parts.begin(), task.parts.end(), part) != task.parts.end();
  };
  const double warm_up =
      words.warm_up.empty() ? 5.0 : options.number("--warm-up", words.warm_up, 1e-3, 1e4);  // to the steady state
  task.replicas = words.replicas.empty() ? (words.quick ? 1 : 2) : options.whole("--replicas", words.replicas, 1, 1000);
  task.cache = words.cache.empty() ? default_cache() : std::filesystem::path(words.cache);
  if (asked("statistical")) ask_statistics(words, warm_up, task, options);
  if (asked("error")) ask_orders(words, warm_up, task, options);
  options.finish();
  return task;
}

void deliver(const Words& words, const std::string& name, const std::string& text, const nlohmann::ordered_json& json) {
  fmt::print("{}", words.json ? json.dump(2) + "\n" : text);
  std::fflush(stdout);
  if (words.out.empty()) return;
  const std::filesystem::path folder = words.out;
  make_folder(folder);
  write_text(folder / (name + ".json"), json.dump(2) + "\n");
  write_text(folder / (name + ".csv"), as_csv(json.at("rows")));
}

void run_deterministic(const Task& task, const Words& words) {
  std::vector<Convergence> measured;
  for (const StartCase* start : task.cases) {
    for (const Variant* variant : task.variants) {
      measured.push_back(measure_convergence(*start, *variant, task.convergence));
    }
  }
  deliver(words, "deterministic", as_text(measured), as_json(measured));
  if (!words.out.empty()) draw_convergence(words.out, measured);
  for (const Convergence& of : measured) {
    for (const StepErrors& step : of.steps) {
      if (!step.states_equal) {
        throw Failure(ExitCode::kFailed, fmt::format("{}, {}, {:.10g} us: the steppers' states differ", of.start->name,
                                                     of.variant->name, 1e6 * step.dt));
      }
    }
  }
}

void run_statistical(const Task& task, const Words& words) {
  std::vector<Statistics> measured;
  for (const StatisticsTask& one : task.statistics) measured.push_back(measure_statistics(one, task.cache));
  deliver(words, "statistical", as_text(measured), as_json(measured));
  if (!words.out.empty()) draw_statistics(words.out, measured);
}

void run_error(const Task& task, const Words& words) {
  std::vector<OrderError> measured;
  for (const auto& [scene, measure] : task.orders) {
    measured.push_back(measure_order_error(scene, measure, task.replicas, task.cache));
  }
  const auto large = extrapolate(measured, *task.paper);
  deliver(words, "error", as_text(measured, large), as_json(measured, large));
  if (!words.out.empty()) draw_order_error(words.out, measured);
}

ExitCode run(const Words& words) {
  const Task task = read(words);
  for (const std::string& part : task.parts) {
    if (part == "deterministic") run_deterministic(task, words);
    if (part == "statistical") run_statistical(task, words);
    if (part == "error") run_error(task, words);
  }
  return ExitCode::kOk;
}

}  // namespace

void add_accuracy(CLI::App& app, Work& work) {
  const auto words = std::make_shared<Words>();
  CLI::App* accuracy = app.add_subcommand("accuracy", "What accuracy costs: errors against the step and CPU time");
  accuracy->footer(kFooter);
  const auto option = [&](const char* name, std::string& word, const char* type, const char* help) {
    accuracy->add_option(name, word, help)->type_name(type);
  };
  option("part", words->part, "PART", "What to measure; everything if left out");
  accuracy->add_flag("--quick", words->quick, "Fewer and shorter measurements");
  accuracy->add_flag("--full", words->full, "More and longer ones");
  option("--cases", words->cases, "LIST", "deterministic: only these");
  option("--variants", words->variants, "LIST",
         "How impacts are treated, of newton, instant, poisson, energetic; deterministic: all, statistical: newton");
  option("--knobs", words->knobs, "LIST", "statistical: only these of step, pitch, sweeps");
  option("--steps", words->steps, "LIST", "Steps [us]: 64 halved some times");
  option("--members", words->members, "N", "deterministic: starts in each ensemble");
  option("--measure", words->measure, "S", "statistical, error: simulated seconds per value and replica");
  option("--replicas", words->replicas, "N", "statistical, error: runs with seeds of their own; 2, or 1 with --quick");
  option("--side", words->side, "MM", "statistical: side of the box");
  option("--sides", words->sides, "LIST", "error: sides of the boxes [mm]");
  option("--warm-up", words->warm_up, "S", "statistical, error: simulated seconds to the steady state; 5");
  option("--cache", words->cache, "DIR", "Where steady states are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "DIR", "Also write CSV, JSON and PNG there");
  accuracy->add_flag("--json", words->json, "Print JSON");
  accuracy->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
