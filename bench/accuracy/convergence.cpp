#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/failure.h"
#include "base/progress_line.h"
#include "bench/accuracy/errors.h"
#include "sim/balance.h"

namespace shaken::bench {
namespace {

constexpr int kConvergedBy = 64;  ///< the converged solution's step is the finest step over this
constexpr int kTimedMembers = 4;  ///< by the reference stepper too, to be timed and compared

const std::vector<Column> kErrorColumns{{"case", "case"},
                                        {"variant", "variant"},
                                        {"dt us", "dt_s", "{:.10g}", 1e6},
                                        {"position mm", "error/position/median", "{:.2e}"},
                                        {"lower", "error/position/lower", "{:.2e}"},
                                        {"upper", "error/position/upper", "{:.2e}"},
                                        {"director rad", "error/director/median", "{:.2e}"},
                                        {"energy", "error/energy/median", "{:.2e}"},
                                        {"scheduled us", "scheduled_cpu_s", "{:.4g}", 1e6},
                                        {"reference us", "reference_cpu_s", "{:.4g}", 1e6},
                                        {"ratio", "reference_over_scheduled", "{:.1f}"},
                                        {"trouble", "in_trouble"},
                                        {"same state", "states_equal"}};
const std::vector<Column> kConvergedColumns{{"case", "case"},
                                            {"variant", "variant"},
                                            {"dt ns", "dt_s", "{:.4g}", 1e9},
                                            {"impulses", "impulses", "{:.4g}"},
                                            {"position", "error/position/upper", "{:.2e}"},
                                            {"director", "error/director/upper", "{:.2e}"},
                                            {"energy", "error/energy/upper", "{:.2e}"},
                                            {"position", "from_first/position/median", "{:.2e}"},
                                            {"director", "from_first/director/median", "{:.2e}"},
                                            {"energy", "from_first/energy/median", "{:.2e}"}};

/// Errors of the members of an ensemble, by norm.
struct Samples {
  std::array<std::vector<double>, kNormNames.size()> of;

  void add(const Errors& errors) {
    for (std::size_t n = 0; n < errors.size(); ++n) of[n].push_back(errors[n]);
  }
  Json json() const {
    Json norms;
    for (std::size_t n = 0; n < of.size(); ++n) norms[kNormNames[n]] = quartiles_of(of[n]);
    return norms;
  }
};

/// What was measured at one step over the ensemble.
struct StepErrors {
  Samples errors;
  double scheduled_cpu = 0, reference_cpu = 0;  ///< of all members [s]
  bool states_equal = true;
  int in_trouble = 0;  ///< members that ended in numerical trouble: not in `errors`
};

/// To the end of the case; the CPU time is added to `cpu`. False on numerical trouble.
bool finish(Simulation& simulation, const StartCase& start, double& cpu) {
  const Tick end = std::llround(start.duration / simulation.world().system.dt);
  const double begun = cpu_seconds();
  const bool well = !simulation.advance_to(end);
  cpu += cpu_seconds() - begun;
  return well;
}

}  // namespace

Json quartiles_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    if (values.empty()) return Json();
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return Json(std::lerp(values[below], values[above], place - static_cast<double>(below)));
  };
  return {{"lower", at(0.25)}, {"median", at(0.5)}, {"upper", at(0.75)}};
}

Errors errors_between(const World& state, const World& truth) {
  const Snapshot a = snapshot(state);
  const Snapshot b = snapshot(truth);
  double position = 0;
  double angle = 0;
  for (std::size_t i = 0; i < b.n_rods(); ++i) {
    Vec3 apart = a.position[i] - b.position[i];
    for (int axis = 0; axis < 2; ++axis) apart[axis] += (a.image[i][axis] - b.image[i][axis]) * b.box[axis];
    position += apart.squaredNorm();
    // exact for small angles too, where the cosine loses all digits
    const double turn = 2 * std::atan2((a.director[i] - b.director[i]).norm(), (a.director[i] + b.director[i]).norm());
    angle += turn * turn;
  }
  const auto n = static_cast<double>(b.n_rods());
  const double energy = kinetic_energy(truth).total();
  return {std::sqrt(position / n), std::sqrt(angle / n), std::abs(kinetic_energy(state).total() - energy) / energy};
}

Json measure_convergence(const StartCase& start, const Variant& variant, const ConvergenceEffort& effort) {
  const int members = effort.members.value_or(start.members);
  const double converged_dt = effort.steps.front() / kConvergedBy;
  std::vector<StepErrors> steps(effort.steps.size());
  Samples floor, from_first;
  double impulses = 0;
  ProgressLine progress(fmt::format("{}, {}", start.name, variant.name));
  for (int member = 0; member < members; ++member) {
    const std::vector<Flight> rods = start.rods(member);
    double unused = 0;
    Simulation truth = begin(start, rods, variant, StepperKind::kScheduled, converged_dt);
    Simulation nearly = begin(start, rods, variant, StepperKind::kScheduled, 2 * converged_dt);
    if (!finish(truth, start, unused) || !finish(nearly, start, unused)) {
      throw Failure(ExitCode::kFailed, fmt::format("{}: numerical trouble in the converged solution", start.name));
    }
    floor.add(errors_between(nearly.world(), truth.world()));
    if (&variant != &variants().front()) {
      Simulation first = begin(start, rods, variants().front(), StepperKind::kScheduled, converged_dt);
      if (finish(first, start, unused)) from_first.add(errors_between(truth.world(), first.world()));
    }
    const Counters& done = truth.world().counters;
    impulses += static_cast<double>(done.impulses_rod_rod + done.impulses_rod_base + done.impulses_rod_lid);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      StepErrors& step = steps[k];
      Simulation simulation = begin(start, rods, variant, StepperKind::kScheduled, effort.steps[k]);
      if (finish(simulation, start, step.scheduled_cpu)) {
        step.errors.add(errors_between(simulation.world(), truth.world()));
      } else {
        ++step.in_trouble;
      }
      if (member < kTimedMembers) {
        Simulation reference = begin(start, rods, variant, StepperKind::kReference, effort.steps[k]);
        finish(reference, start, step.reference_cpu);
        step.states_equal &= reference.state_hash() == simulation.state_hash();
      }
    }
    progress.show((member + 1.0) / members);
  }

  const Json series{{"case", start.name}, {"variant", variant.name}};
  Json converged = series;
  converged.update({{"dt_s", converged_dt}, {"impulses", impulses / members}, {"error", floor.json()}});
  if (&variant != &variants().front()) converged["from_first"] = from_first.json();
  Json rows = Json::array();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double scheduled_cpu = steps[k].scheduled_cpu / members;
    const double reference_cpu = steps[k].reference_cpu / std::min(kTimedMembers, members);
    rows.push_back(series);
    rows.back().update({{"duration_s", start.duration},
                        {"members", members},
                        {"dt_s", effort.steps[k]},
                        {"error", steps[k].errors.json()},
                        {"scheduled_cpu_s", scheduled_cpu},
                        {"reference_cpu_s", reference_cpu},
                        {"reference_over_scheduled", reference_cpu / scheduled_cpu},
                        {"states_equal", steps[k].states_equal},
                        {"in_trouble", steps[k].in_trouble}});
  }
  return {{"rows", rows}, {"converged", converged}};
}

Report convergence_report(const std::vector<Json>& measured) {
  Report report("accuracy", "accuracy");
  report.has_verdict = true;
  report.json["converged"] = Json::array();
  for (const Json& of : measured) {
    report.add(of.at("rows"));
    report.json["converged"].push_back(of.at("converged"));
  }
  report.text +=
      "\nErrors against a converged solution at the end of each case: median over an ensemble of starts, and its\n"
      "quartiles for the position. CPU time of one start. Energy: kinetic, relative.\n" +
      table(report.rows(), kErrorColumns) +
      "\nConverged solutions: their step, the impulses of one start, what one of twice that step is off by\n"
      "(upper quartile), and how far they are from that of the first variant (median).\n" +
      table(report.json["converged"], kConvergedColumns);
  return report;
}

}  // namespace shaken::bench
