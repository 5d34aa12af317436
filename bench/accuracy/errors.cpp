#include "bench/accuracy/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "bench/bench.h"

namespace shaken::bench {
namespace {

constexpr const char* kAccuracyFooter =
    R"(Errors of a few rods against converged solutions, and their order: some 20 minutes of CPU time, a quarter of that
with --quick. What the step does to averages, a sweep measures (docs/accuracy.md).

Examples:
  shaken bench accuracy --quick
  shaken bench accuracy --out accuracy     convergence.png, work_precision.png, CSV, JSON
  shaken bench accuracy --cases head-on,wedged --steps 64,32,16,8,4,2,1

Exit codes: 0 done, 1 the steppers' states differ or something failed, 2 bad input.)";

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
  bool quick = false;
  std::vector<std::string> cases, treatments;
  std::vector<double> steps;  ///< [us]
  std::optional<int> members;
  Output output;

  void declare(CLI::App& app) {
    app.add_flag("--quick", quick, "Fewer steps and starts");
    add_names(app, "--cases", cases, "LIST", names_of(start_cases()), "Only these");
    add_names(app, "--variants", treatments, "LIST", names_of(variants()), "How impacts are treated; all if left out");
    add_number(app, "--steps", steps, "LIST", {1.0 / 64, 1e6 * kLongestStep}, "Steps [us]: 64 halved some times")
        ->check([](const std::string& us) { return step_problem(us); });
    add_number(app, "--members", members, "N", {1, 100'000}, "Starts in each ensemble");
    output.declare(app);
  }

  /// Rising, each once [us].
  std::set<double> wanted_steps() const {
    std::set<double> wanted(steps.begin(), steps.end());
    if (!wanted.empty()) return wanted;
    for (double us = quick ? 1 : 0.25; us < 1.1e6 * kLongestStep; us *= 2) wanted.insert(us);
    return wanted;
  }

  ExitCode run() const {
    ConvergenceEffort how;
    for (const double us : wanted_steps()) how.steps.push_back(1e-6 * us);
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
    return ExitCode::kOk;
  }
};

}  // namespace

void add_accuracy(CLI::App& app, Work& work) {
  add_bench<AccuracyBench>(app, work, "accuracy", "What accuracy costs: errors against the step and CPU time",
                           kAccuracyFooter);
}

}  // namespace shaken::bench
