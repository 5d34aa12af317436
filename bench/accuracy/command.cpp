// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "bench/accuracy/convergence.h"
#include "bench/accuracy/report.h"
#include "bench/commands.h"
#include "bench/options.h"
#include "bench/picture.h"
#include "bench/speed/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kFooter = R"(Parts:
  deterministic  errors against converged solutions of a few rods, and their order
  (none)         all of them

Examples:
  shaken bench accuracy --quick
  shaken bench accuracy deterministic --out accuracy     convergence.png, work_precision.png, CSV, JSON
  shaken bench accuracy deterministic --cases head-on,wedged --steps 64,32,16,8,4,2,1

Exit codes: 0 done, 1 the steppers' states differ or something failed, 2 bad input.)";

const std::vector<std::string> kParts{"deterministic"};

/// The options as the user wrote them; empty where nothing was said.
struct Words {
  std::string part, cases, steps, members, cache, out;
  bool quick = false, full = false, json = false;
};

struct Task {
  std::vector<std::string> parts;
  std::vector<const StartCase*> cases;
  ConvergenceEffort convergence;
};

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

std::vector<const StartCase*> asked_cases(const std::string& words, OptionReader& options) {
  std::vector<const StartCase*> cases;
  if (words.empty()) {
    for (const StartCase& start : start_cases()) cases.push_back(&start);
    return cases;
  }
  for (const std::string& name : split(words)) {
    const auto found = std::find_if(start_cases().begin(), start_cases().end(),
                                    [&](const StartCase& start) { return start.name == name; });
    if (found != start_cases().end()) {
      cases.push_back(&*found);
      continue;
    }
    std::string known;
    for (const StartCase& start : start_cases()) known += (known.empty() ? "" : ", ") + start.name;
    options.complain(fmt::format("--cases: '{}' is not one of {}", name, known));
  }
  return cases;
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
  task.cases = asked_cases(words.cases, options);
  task.convergence.steps =
      words.steps.empty() ? halved_steps(words.quick ? 1e-6 : 0.25e-6) : asked_steps(words.steps, options);
  if (words.quick) task.convergence.members = 16;
  if (words.full) task.convergence.converged_by = 128;
  if (!words.members.empty()) task.convergence.members = options.whole("--members", words.members, 1, 100'000);
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
    for (const Variant& variant : variants()) {
      measured.push_back(measure_convergence(*start, variant, task.convergence));
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

ExitCode run(const Words& words) {
  const Task task = read(words);
  for (const std::string& part : task.parts) {
    if (part == "deterministic") run_deterministic(task, words);
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
  option("--steps", words->steps, "LIST", "Steps [us]: 64 halved some times");
  option("--members", words->members, "N", "deterministic: starts in each ensemble");
  option("--cache", words->cache, "DIR", "Where steady states are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "DIR", "Also write CSV, JSON and PNG there");
  accuracy->add_flag("--json", words->json, "Print JSON");
  accuracy->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
