// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/failure.h"
#include "base/progress_line.h"
#include "bench/accuracy/accuracy.h"
#include "bench/fits.h"
#include "sim/balance.h"

namespace shaken::bench {
namespace {

constexpr std::array<const char*, kNormNames.size()> kNormUnits{"mm", "rad", "1"};
constexpr int kConvergedBy = 64;  ///< the converged solution's step is the finest step over this
constexpr int kTimedMembers = 4;  ///< by the reference stepper too, to be timed and compared

/// Errors of the members of an ensemble, by norm.
class Samples {
 public:
  void add(const Errors& errors) {
    for (std::size_t n = 0; n < errors.size(); ++n) samples_[n].push_back(errors[n]);
  }
  bool empty() const { return samples_[0].empty(); }
  Quartiles quartiles(std::size_t norm) const { return empty() ? Quartiles{} : quartiles_of(samples_[norm]); }
  Json json(std::size_t norm) const {
    const Quartiles of = quartiles(norm);
    return {{"lower", of.lower}, {"median", of.median}, {"upper", of.upper}};
  }

 private:
  std::array<std::vector<double>, kNormNames.size()> samples_;
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

Errors errors_between(const World& state, const World& truth) {
  const Snapshot a = snapshot(state);
  const Snapshot b = snapshot(truth);
  double position = 0;
  double angle = 0;
  for (std::size_t i = 0; i < b.n_rods(); ++i) {
    Vec3 apart = a.position[i] - b.position[i];
    for (int axis = 0; axis < 2; ++axis) apart[axis] += (a.image[i][axis] - b.image[i][axis]) * b.box_side;
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

  Json rows = Json::array();
  Json order{{"case", start.name},
             {"variant", variant.name},
             {"impulses", impulses / members},
             {"converged_dt_s", converged_dt}};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double scheduled_cpu = steps[k].scheduled_cpu / members;
    const double reference_cpu = steps[k].reference_cpu / std::min(kTimedMembers, members);
    Json row{{"case", start.name},
             {"variant", variant.name},
             {"duration_s", start.duration},
             {"members", members},
             {"dt_s", effort.steps[k]}};
    for (std::size_t n = 0; n < kNormNames.size(); ++n) row["error"][kNormNames[n]] = steps[k].errors.json(n);
    row.update({{"scheduled_cpu_s", scheduled_cpu},
                {"reference_cpu_s", reference_cpu},
                {"reference_over_scheduled", reference_cpu / scheduled_cpu},
                {"states_equal", steps[k].states_equal},
                {"in_trouble", steps[k].in_trouble}});
    rows.push_back(std::move(row));
  }
  for (std::size_t n = 0; n < kNormNames.size(); ++n) {
    Json& norm = order[kNormNames[n]] = {{"unit", kNormUnits[n]}, {"floor", floor.json(n)}};
    if (!from_first.empty()) norm["from_first"] = from_first.json(n);
    norm["order"] = nullptr;
    std::vector<double> medians(steps.size());
    std::transform(steps.begin(), steps.end(), medians.begin(),
                   [&](const StepErrors& step) { return step.errors.quartiles(n).median; });
    if (const auto fit = fit_order(effort.steps, medians, floor.quartiles(n).upper)) {
      norm.update({{"order", fit->order},
                   {"order_error", fit->order_error},
                   {"coefficient", fit->coefficient},
                   {"finest_dt_s", effort.steps[fit->first]},
                   {"points", fit->points}});
    }
  }
  return {{"what", start.what}, {"rows", rows}, {"order", order}};
}

namespace {

/// "2.05e-06 mm, 1.2e-06 rad, 3.1e-07" of every norm.
std::string norms_text(const Json& order, const std::string& member) {
  const auto of = [&](std::size_t n) { return member_of(order.at(kNormNames[n]), member).get<double>(); };
  return fmt::format("{:.2e} mm, {:.2e} rad, {:.2e}", of(0), of(1), of(2));
}

std::string convergence_text(const Json& of) {
  const Json& order = of.at("order");
  const Json& first = of.at("rows").at(0);
  const std::string error = "{:.2e}";
  std::string text = fmt::format("\n{} ({}), {}: {} starts, {:.3f} ms, {:.4g} impulses each\n", text_of(order, "case"),
                                 text_of(of, "what"), text_of(order, "variant"), first.at("members").get<int>(),
                                 1e3 * first.at("duration_s").get<double>(), order.at("impulses").get<double>());
  text += table(of.at("rows"), {{"dt us", "dt_s", "{:.10g}", 1e6},
                                {"position mm", "error/position/median", error},
                                {"lower", "error/position/lower", error},
                                {"upper", "error/position/upper", error},
                                {"director rad", "error/director/median", error},
                                {"energy", "error/energy/median", error},
                                {"scheduled us", "scheduled_cpu_s", "{:.4g}", 1e6},
                                {"reference us", "reference_cpu_s", "{:.4g}", 1e6},
                                {"ratio", "reference_over_scheduled", "{:.1f}"},
                                {"same state", "states_equal"},
                                {"trouble", "in_trouble"}});
  text += fmt::format("converged solution at {:.4g} ns; one of twice that step is off by {} (upper quartile)\n",
                      1e9 * order.at("converged_dt_s").get<double>(), norms_text(order, "floor/upper"));
  if (order.at(kNormNames[0]).contains("from_first")) {
    text += fmt::format("distance from the converged solution of {}: {} (median)\n", variants().front().name,
                        norms_text(order, "from_first/median"));
  }
  return text;
}

}  // namespace

Report convergence_report(const std::vector<Json>& measured) {
  Report report("deterministic", "accuracy deterministic");
  report.json["orders"] = Json::array();
  report.text +=
      "\nErrors against a converged solution at the end of each case: median over an ensemble of starts, and its\n"
      "quartiles for the position. CPU time of one start. Energy: kinetic, relative.\n";
  for (const Json& of : measured) {
    report.text += convergence_text(of);
    report.add(of.at("rows"));
    report.json["orders"].push_back(of.at("order"));
  }
  report.text += fmt::format(
      "\nOrder of convergence: slope of the median error in log-log, its standard error, and from how many steps. The\n"
      "finest {} steps count, then each next one while it stays within a factor {:g} of the line; errors below {:g} "
      "times\nwhat the converged solution is off by do not.\n",
      kLeast, kOnLine, kAboveFloor);
  std::vector<Column> columns{{"case", "case"}, {"variant", "variant"}};
  for (const std::string name : kNormNames) {
    columns.push_back({name, name + "/order", "{:.2f} +- {:.2f}", 1, name + "/order_error"});
    columns.push_back({"of", name + "/points"});
  }
  report.text += table(report.json["orders"], columns);
  return report;
}

}  // namespace shaken::bench
