// SPDX-License-Identifier: MIT
#include "bench/accuracy/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "bench/bench.h"

namespace shaken::bench {
namespace {

constexpr const char* kAccuracyFooter = R"(Parts:
  deterministic  errors of a few rods against converged solutions, and their order
  statistical    bias of temperatures, order, drift, displacements with step, bead pitch and sweeps
  (none)         both: about 40 minutes of CPU time, a quarter of that with --quick

Examples:
  shaken bench accuracy --quick
  shaken bench accuracy deterministic --out accuracy     convergence.png, work_precision.png, CSV, JSON
  shaken bench accuracy deterministic --cases head-on,wedged --steps 64,32,16,8,4,2,1
  shaken bench accuracy statistical --out accuracy       bias.png, tilt.png, model.png, CSV, JSON
  shaken bench accuracy statistical --knobs step --variants newton,instant --measure 60 --out accuracy   cost.png too

Exit codes: 0 done, 1 the steppers' states differ or something failed, 2 bad input.)";

/// `finest` doubled up to kLongestStep [us].
std::vector<double> halved_steps(double finest) {
  std::vector<double> steps;
  for (double us = finest; us < 1.1e6 * kLongestStep; us *= 2) steps.push_back(us);
  return steps;
}

/// Says what is wrong with a step in microseconds, if anything is.
std::string step_problem(const std::string& us) {
  const double halvings = std::log2(1e6 * kLongestStep / std::strtod(us.c_str(), nullptr));
  return halvings == std::round(halvings) ? "" : us + " is not 64 us halved some times";
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.emplace_back(one.name);
  return names;
}

/// Whether a name is one of these, or none was named.
bool is_asked(const std::vector<std::string>& names, const char* name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

struct AccuracyBench {
  std::string part;
  bool quick = false;
  std::vector<std::string> cases, treatments, knobs;
  std::vector<double> steps;  ///< [us]
  std::optional<int> members, replicas;
  std::optional<double> measure, side;
  double warm_up = 5;
  Cache cache;
  Output output;

  void declare(CLI::App& app) {
    app.add_option("part", part, "What to measure; everything if left out")
        ->type_name("PART")
        ->check(CLI::IsMember({"deterministic", "statistical"}).description(""));
    app.add_flag("--quick", quick, "Fewer and shorter measurements");
    add_names(app, "--cases", cases, "LIST", names_of(start_cases()), "deterministic: only these");
    add_names(app, "--variants", treatments, "LIST", names_of(variants()),
              "How impacts are treated; deterministic: all, statistical: newton");
    add_names(app, "--knobs", knobs, "LIST", {"step", "pitch", "sweeps"}, "statistical: only these");
    add_number(app, "--steps", steps, "LIST", {1.0 / 64, 1e6 * kLongestStep}, "Steps [us]: 64 halved some times")
        ->check([](const std::string& us) { return step_problem(us); });
    add_number(app, "--members", members, "N", {1, 100'000}, "deterministic: starts in each ensemble");
    add_number(app, "--measure", measure, "S", {0.01, 1e6}, "statistical: simulated seconds per value and replica");
    add_number(app, "--replicas", replicas, "N", {1, 1000},
               "statistical: runs with seeds of their own; 2, or 1 with --quick");
    add_number(app, "--side", side, "MM", limits_of("box.side"), "statistical: side of the box");
    add_number(app, "--warm-up", warm_up, "S", kWarmUps, "statistical: simulated seconds to the steady state");
    cache.declare(app);
    output.declare(app);
  }

  /// How much longer than usual things are measured.
  double effort() const { return quick ? 0.2 : 1; }
  int n_replicas() const { return replicas.value_or(quick ? 1 : 2); }
  /// The steps that were asked for, each once and rising [us].
  std::vector<double> asked_steps() const {
    const std::set<double> asked(steps.begin(), steps.end());
    return {asked.begin(), asked.end()};
  }

  void run_deterministic() const {
    ConvergenceEffort how;
    for (const double us : steps.empty() ? halved_steps(quick ? 1 : 0.25) : asked_steps()) {
      how.steps.push_back(1e-6 * us);
    }
    how.members = quick && !members ? 16 : members;
    std::vector<Json> measured;
    for (const StartCase& start : start_cases()) {
      if (!is_asked(cases, start.name.c_str())) continue;
      for (const Variant& variant : variants()) {
        if (is_asked(treatments, variant.name)) measured.push_back(measure_convergence(start, variant, how));
      }
    }
    const Report report = convergence_report(measured);
    output.give(report);
    for (const Json& row : report.rows()) {
      if (row.at("states_equal").get<bool>()) continue;
      throw Failure(ExitCode::kFailed,
                    fmt::format("{}, {}, {:.10g} us: the steppers' states differ", text_of(row, "case"),
                                text_of(row, "variant"), 1e6 * row.at("dt_s").get<double>()));
    }
  }

  /// What the knobs are turned in: the paper's dense rods, and shorter ones that drift.
  std::vector<StatisticsTask> statistics_tasks() const {
    const std::vector<double> step_values = steps.empty() ? std::vector{1., 2., 4., 8., 16., 32., 64.} : asked_steps();
    std::vector<StatisticsTask> tasks;
    const auto add = [&](const Knob& knob, const std::vector<double>& values, double length, double fraction,
                         double box, double seconds) {
      const Case scene = make_case(length, fraction, side.value_or(box), kPaperStep, warm_up);
      for (const Variant& variant : variants()) {
        if (treatments.empty() ? &variant != &variants().front() : !is_asked(treatments, variant.name)) continue;
        tasks.push_back({scene, &variant, &knob, values, measure.value_or(seconds * effort()), std::min(1.0, warm_up),
                         n_replicas()});
      }
    };
    if (is_asked(knobs, "step")) {
      add(kStepKnob, step_values, 4.5, 0.75, 25, 30);
      add(kStepKnob, step_values, 2.5, 0.60, 20, 50);
    }
    if (is_asked(knobs, "pitch")) add(kPitchKnob, {0.15, 0.2, 0.3, 0.45, 0.6}, 4.5, 0.75, 25, 15);
    if (is_asked(knobs, "sweeps")) add(kSweepsKnob, {8, 4, 2, 1}, 4.5, 0.75, 25, 15);
    return tasks;
  }

  void run_statistical() const {
    std::vector<Json> measured;
    for (const StatisticsTask& task : statistics_tasks()) measured.push_back(measure_statistics(task, cache));
    output.give(statistics_report(measured));
  }

  ExitCode run() const {
    if (part.empty() || part == "deterministic") run_deterministic();
    if (part.empty() || part == "statistical") run_statistical();
    return ExitCode::kOk;
  }
};

}  // namespace

void add_accuracy(CLI::App& app, Work& work) {
  add_bench<AccuracyBench>(app, work, "accuracy", "What accuracy costs: errors against the step and CPU time",
                           kAccuracyFooter);
}

}  // namespace shaken::bench
