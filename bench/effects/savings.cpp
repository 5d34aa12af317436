// SPDX-License-Identifier: MIT
#include "bench/effects/savings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/progress.h"
#include "sim/effects/registry.h"

namespace shaken::bench {
namespace {

double cost(const EngineSpeed& speed) { return speed.best_cpu() / speed.rod_seconds; }

/// The case from its steady state on; a vibration goes by before it is handed out, so that lists and schedules are
/// there.
Contender from_steady_state(const std::string& name, const Case& scene, const std::filesystem::path& cache) {
  return {name, scene, [scene, state = steady_state(scene, cache)] {
            Simulation simulation = resumed(scene, state, Engine::kScheduled);
            advance(simulation, scene.period_ticks());
            return simulation;
          }};
}

}  // namespace

double Comparison::ratio() const { return cost(speed) / cost(yardstick); }

double Comparison::error() const {
  const std::size_t n = speed.cpu.size();
  if (n < 2) return 0;
  std::vector<double> ratios;
  for (std::size_t k = 0; k < n; ++k) {
    ratios.push_back(speed.cpu[k] / speed.rod_seconds / (yardstick.cpu[k] / yardstick.rod_seconds));
  }
  const double mean = std::accumulate(ratios.begin(), ratios.end(), 0.0) / static_cast<double>(n);
  double squares = 0;
  for (const double r : ratios) squares += (r - mean) * (r - mean);
  return std::sqrt(squares / static_cast<double>(n * (n - 1)));
}

Comparison compare(const Contender& contender, const Contender& yardstick, const Effort& effort) {
  Comparison comparison{contender.name, {}, {}};
  // as many ticks as make whole vibrations and fill the time
  Simulation trial = yardstick.make();
  EngineSpeed one_period;
  time_stretch(trial, yardstick.scene, yardstick.scene.period_ticks(), one_period);
  const double periods = std::max(1.0, std::round(effort.cpu / one_period.best_cpu()));
  for (int repetition = 0; repetition < effort.repeat; ++repetition) {
    const auto time = [&](const Contender& one, EngineSpeed& speed) {
      Simulation simulation = one.make();
      time_stretch(simulation, one.scene, static_cast<Tick>(periods) * one.scene.period_ticks(), speed);
    };
    time(yardstick, comparison.yardstick);
    time(contender, comparison.speed);
  }
  return comparison;
}

std::vector<Saving> measure_savings(const Case& everything, const std::filesystem::path& cache, const Effort& effort) {
  const Contender all_on = from_steady_state("everything on", everything, cache);
  std::vector<Saving> savings;
  const auto measure = [&](std::string name, const Case& scene, std::string neutral) {
    Saving saving{std::move(name), std::move(neutral), {}, ""};
    if (const auto started = Simulation::start(scene.system()); !started) {
      saving.impossible = started.error().message;
    } else {
      ProgressLine progress("measuring without " + saving.effect);
      saving.comparison = compare(from_steady_state(saving.effect, scene, cache), all_on, effort);
    }
    savings.push_back(std::move(saving));
  };
  // the same against itself: how far to trust the other figures
  measure("(nothing)", everything, "");
  for (const Effect& effect : all_effects()) {
    if (effect.switch_off == nullptr || !effect.is_on(everything.system())) continue;
    Case without = everything;
    effect.switch_off(without.plan.system);
    measure(std::string(effect.name), without, effect.why(without.system()));
  }
  return savings;
}

}  // namespace shaken::bench
