// SPDX-License-Identifier: MIT
#include "bench/accuracy/convergence.h"

#include <fmt/format.h>

#include <cmath>

#include "base/clock.h"
#include "base/failure.h"
#include "base/progress_line.h"
#include "sim/balance.h"

namespace shaken::bench {
namespace {

using Samples = std::array<std::vector<double>, kNorms>;

void add(Samples& samples, const Errors& errors) {
  for (int n = 0; n < kNorms; ++n) samples[n].push_back(errors[n]);
}

std::array<Quartiles, kNorms> reduced(const Samples& samples) {
  std::array<Quartiles, kNorms> out;
  for (int n = 0; n < kNorms; ++n) {
    if (!samples[n].empty()) out[n] = quartiles_of(samples[n]);
  }
  return out;
}

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

Convergence measure_convergence(const StartCase& start, const Variant& variant, const ConvergenceEffort& effort) {
  Convergence result;
  result.start = &start;
  result.variant = &variant;
  result.members = effort.members.value_or(start.members);
  result.converged_dt = effort.steps.front() / effort.converged_by;
  for (const double dt : effort.steps) result.steps.push_back({dt, {}, 0, 0, true, 0});

  std::vector<Samples> errors(effort.steps.size());
  Samples floor, from_first;
  ProgressLine progress(fmt::format("{}, {}", start.name, variant.name));
  for (int member = 0; member < result.members; ++member) {
    const std::vector<Flight> rods = start.rods(member);
    double unused = 0;
    Simulation truth = begin(start, rods, variant, Engine::kScheduled, result.converged_dt);
    Simulation nearly = begin(start, rods, variant, Engine::kScheduled, 2 * result.converged_dt);
    if (!finish(truth, start, unused) || !finish(nearly, start, unused)) {
      throw Failure(ExitCode::kFailed, fmt::format("{}: numerical trouble in the converged solution", start.name));
    }
    add(floor, errors_between(nearly.world(), truth.world()));
    if (&variant != &variants().front()) {
      Simulation first = begin(start, rods, variants().front(), Engine::kScheduled, result.converged_dt);
      if (finish(first, start, unused)) add(from_first, errors_between(truth.world(), first.world()));
    }
    const Counters& done = truth.world().counters;
    result.impulses += static_cast<double>(done.impulses_rod_rod + done.impulses_rod_base + done.impulses_rod_lid);
    for (std::size_t k = 0; k < effort.steps.size(); ++k) {
      StepErrors& step = result.steps[k];
      Simulation simulation = begin(start, rods, variant, Engine::kScheduled, step.dt);
      const bool well = finish(simulation, start, step.scheduled_cpu);
      if (well) {
        add(errors[k], errors_between(simulation.world(), truth.world()));
      } else {
        ++step.in_trouble;
      }
      if (member < effort.timed_members) {
        Simulation reference = begin(start, rods, variant, Engine::kReference, step.dt);
        finish(reference, start, step.reference_cpu);
        step.states_equal &= reference.state_hash() == simulation.state_hash();
      }
    }
    progress.show((member + 1.0) / result.members);
  }

  result.impulses /= result.members;
  result.floor = reduced(floor);
  if (!from_first[0].empty()) result.from_first = reduced(from_first);
  for (std::size_t k = 0; k < effort.steps.size(); ++k) {
    result.steps[k].errors = reduced(errors[k]);
    result.steps[k].scheduled_cpu /= result.members;
    result.steps[k].reference_cpu /= std::min(effort.timed_members, result.members);
  }
  for (int n = 0; n < kNorms; ++n) {
    std::vector<double> medians;
    for (const StepErrors& step : result.steps) medians.push_back(step.errors[n].median);
    result.orders[n] = fit_order(effort.steps, medians, result.floor[n].upper);
  }
  return result;
}

namespace {

Json quartiles_json(const Quartiles& of) { return {{"lower", of.lower}, {"median", of.median}, {"upper", of.upper}}; }

Json step_row(const Convergence& of, const StepErrors& step) {
  Json row{{"case", of.start->name},
           {"variant", of.variant->name},
           {"duration_s", of.start->duration},
           {"members", of.members},
           {"dt_s", step.dt}};
  for (int n = 0; n < kNorms; ++n) row["error"][kNormNames[n]] = quartiles_json(step.errors[n]);
  row["scheduled_cpu_s"] = step.scheduled_cpu;
  row["reference_cpu_s"] = step.reference_cpu;
  row["reference_over_scheduled"] = step.reference_cpu / step.scheduled_cpu;
  row["states_equal"] = step.states_equal;
  row["in_trouble"] = step.in_trouble;
  return row;
}

Json order_row(const Convergence& of) {
  Json row{{"case", of.start->name},
           {"variant", of.variant->name},
           {"impulses", of.impulses},
           {"converged_dt_s", of.converged_dt}};
  for (int n = 0; n < kNorms; ++n) {
    Json& norm = row[kNormNames[n]];
    norm["unit"] = kNormUnits[n];
    norm["floor"] = quartiles_json(of.floor[n]);
    if (of.from_first) norm["from_first"] = quartiles_json((*of.from_first)[n]);
    norm["order"] = nullptr;
    if (const auto& fit = of.orders[n]) {
      norm["order"] = fit->order;
      norm["order_error"] = fit->order_error;
      norm["coefficient"] = fit->coefficient;
      norm["finest_dt_s"] = of.steps[static_cast<std::size_t>(fit->first)].dt;
      norm["points"] = fit->points;
    }
  }
  return row;
}

std::string convergence_text(const Convergence& of, const Json& rows) {
  const std::string error = "{:.2e}";
  std::string text = fmt::format("\n{} ({}), {}: {} starts, {:.3f} ms, {:.4g} impulses each\n", of.start->name,
                                 of.start->what, of.variant->name, of.members, 1e3 * of.start->duration, of.impulses);
  text += table(rows, {{"dt us", "dt_s", "{:.10g}", 1e6},
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
  text += fmt::format(
      "converged solution at {:.4g} ns; one of twice that step is off by {:.2e} mm, {:.2e} rad, {:.2e} (upper "
      "quartile)\n",
      1e9 * of.converged_dt, of.floor[0].upper, of.floor[1].upper, of.floor[2].upper);
  if (of.from_first) {
    const auto& apart = *of.from_first;
    text += fmt::format("distance from the converged solution of {}: {:.2e} mm, {:.2e} rad, {:.2e} (median)\n",
                        variants().front().name, apart[0].median, apart[1].median, apart[2].median);
  }
  return text;
}

}  // namespace

Report convergence_report(const std::vector<Convergence>& measured) {
  Report report("deterministic", "accuracy deterministic");
  report.json["orders"] = Json::array();
  report.text +=
      "\nErrors against a converged solution at the end of each case: median over an ensemble of starts, and its\n"
      "quartiles for the position. CPU time of one start. Energy: kinetic, relative.\n";
  for (const Convergence& of : measured) {
    Json rows = Json::array();
    for (const StepErrors& step : of.steps) rows.push_back(step_row(of, step));
    report.text += convergence_text(of, rows);
    report.json["rows"].insert(report.json["rows"].end(), rows.begin(), rows.end());
    report.json["orders"].push_back(order_row(of));
  }
  report.text += fmt::format(
      "\nOrder of convergence: slope of the median error in log-log, its standard error, and from how many steps. The\n"
      "finest {} steps count, then each next one while it stays within a factor {:g} of the line; errors below {:g} "
      "times\nwhat the converged solution is off by do not.\n",
      kLeast, kOnLine, kAboveFloor);
  std::vector<Column> columns{{"case", "case"}, {"variant", "variant"}};
  for (const char* norm : kNormNames) {
    const std::string name = norm;
    columns.push_back({name, name + "/order", "{:.2f} +- {:.2f}", 1, name + "/order_error"});
    columns.push_back({"of", name + "/points"});
  }
  report.text += table(report.json["orders"], columns);
  return report;
}

}  // namespace shaken::bench
