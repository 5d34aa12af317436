// SPDX-License-Identifier: MIT
#include "bench/accuracy/convergence.h"

#include <fmt/format.h>

#include <cmath>

#include "base/clock.h"
#include "base/failure.h"
#include "base/progress_line.h"

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
  const Tick end = std::llround(start.duration / simulation.world().scene.dt);
  const double begun = cpu_seconds();
  const bool well = !simulation.advance_to(end);
  cpu += cpu_seconds() - begun;
  return well;
}

}  // namespace

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

}  // namespace shaken::bench
