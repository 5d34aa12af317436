// SPDX-License-Identifier: MIT
#include "bench/effects/savings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/failure.h"
#include "base/progress_line.h"
#include "sim/effects/registry.h"

namespace shaken::bench {
namespace {

double cost(const EngineSpeed& speed) { return speed.best_cpu() / speed.rod_seconds; }

/// The case from `state` on. One tick goes by before it is handed out, so that lists and schedules are there.
Contender contender(const std::string& name, const Case& scene, const SteadyState& state) {
  return {name, scene, [scene, state] {
            Simulation simulation = resumed(scene, state, Engine::kScheduled);
            advance(simulation, 1);
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

Comparison compare(const Contender& contender, const Contender& yardstick, int repeat, int periods, double cpu) {
  const auto ticks_of = [&](const Contender& one) {
    const Tick period = one.scene.period_ticks();
    if (periods > 0) return periods * period;
    Simulation trial = one.make();
    EngineSpeed one_period;
    time_stretch(trial, one.scene, period, one_period);
    return period * static_cast<Tick>(std::max(1.0, std::round(cpu / one_period.best_cpu())));
  };
  const Tick ticks = ticks_of(contender);
  const Tick yardstick_ticks = ticks_of(yardstick);
  Comparison comparison{contender.name, {}, {}};
  for (int repetition = 0; repetition < repeat; ++repetition) {
    Simulation before = yardstick.make();
    time_stretch(before, yardstick.scene, yardstick_ticks, comparison.yardstick);
    Simulation after = contender.make();
    time_stretch(after, contender.scene, ticks, comparison.speed);
  }
  return comparison;
}

std::vector<Saving> measure_savings(const Case& everything, const std::filesystem::path& cache, const Effort& effort) {
  // few enough vibrations for the rods to be still where they would have been, often enough to make up for it
  constexpr int kFewPeriods = 4;
  constexpr int kOften = 3;
  const SteadyState state = steady_state(everything, cache);
  const Contender all_on = contender("everything on", everything, state);
  std::vector<Saving> savings;
  const auto measure = [&](std::string name, const Case& scene, std::string neutral) {
    Saving saving{std::move(name), std::move(neutral), {}, {}, ""};
    if (const auto started = Simulation::start(scene.system()); !started) {
      saving.impossible = started.error().message;
    } else {
      try {
        const SteadyState own = steady_state(scene, cache);
        ProgressLine progress("measuring without " + saving.effect);
        saving.own_state = compare(contender(saving.effect, scene, own), all_on, effort.repeat, 0, effort.cpu);
        if (Simulation::resume(scene.system(), state.checkpoint)) {
          saving.same_state =
              compare(contender(saving.effect, scene, state), all_on, kOften * effort.repeat, kFewPeriods, 0);
        }
      } catch (const Failure& failure) {  // without a base, say, rods fall until they are too fast
        saving.impossible = failure.what();
      }
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
