// SPDX-License-Identifier: MIT
// What each effect of the physics costs: the CPU time without it against that with everything on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/progress_line.h"
#include "bench/accuracy/fits.h"
#include "bench/bench.h"
#include "bench/engine_speed.h"
#include "sim/effects/registry.h"

namespace shaken::bench {
namespace {

constexpr const char* kEffectsFooter =
    R"(Every effect that can be off is switched off, one at a time (docs/effects.md). CPU times are compared from one and the same
state, which tells what it takes to compute the effect, and from a state that came about without it, which tells what a
user gains: mostly nothing, as rods without friction or bounce collide more often. States are kept in the cache.

Examples:
  shaken bench effects                                      527 rods of 4.5 mm at area fraction 0.75
  shaken bench effects --area-fraction 0.45 --out effects   fewer; effects/effects.csv, .json and .png
  shaken bench effects --warm-up 5 --repeat 9               in the steady state of each, with smaller errors

Exit codes: 0 done, 1 something failed, 2 bad input.)";

/// One way to simulate, whose speed is compared with another's.
struct Contender {
  Case scene;
  /// A simulation that is past its warm-up. Made anew for each repetition.
  std::function<Simulation()> make;
};

/// The case from `state` on. One tick goes by before it is handed out, so that lists and schedules are there.
Contender contender(const Case& scene, const SteadyState& state) {
  return {scene, [scene, state] {
            Simulation simulation = resumed(scene, state, Engine::kScheduled);
            advance(simulation, 1);
            return simulation;
          }};
}

/// CPU times of a contender and of the one that it is compared with, taken in turn.
struct Comparison {
  EngineSpeed speed;      ///< of the contender
  EngineSpeed yardstick;  ///< of the other, in the same repetitions

  /// CPU time per rod-second of the contender over that of the yardstick, by the best repetition of each.
  double ratio() const { return yardstick.rate() / speed.rate(); }
  /// Its standard error, from the scatter of the ratios of single repetitions; 0 for one.
  double error() const {
    const std::size_t n = speed.cpu.size();
    if (n < 2) return 0;
    std::vector<double> ratios;
    for (std::size_t k = 0; k < n; ++k) {
      ratios.push_back(speed.cpu[k] / speed.rod_seconds / (yardstick.cpu[k] / yardstick.rod_seconds));
    }
    return mean_of_samples(ratios).sem;
  }
};

/// Steps both, one after the other, `repeat` times. `periods`: so many vibrations each time; 0: as many as take about
/// `cpu` seconds.
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
  Comparison comparison;
  for (int repetition = 0; repetition < repeat; ++repetition) {
    Simulation before = yardstick.make();
    time_stretch(before, yardstick.scene, yardstick_ticks, comparison.yardstick);
    Simulation after = contender.make();
    time_stretch(after, contender.scene, ticks, comparison.speed);
  }
  return comparison;
}

Json json_of(const Comparison& of) {
  const auto per_tick = [&](std::int64_t n) { return static_cast<double>(n) / static_cast<double>(of.speed.ticks); };
  return {{"cpu_ratio", of.ratio()},
          {"cpu_ratio_error", of.error()},
          {"rod_s_per_cpu_s", of.speed.rate()},
          {"everything_rod_s_per_cpu_s", of.yardstick.rate()},
          {"cpu_s", of.speed.cpu},
          {"everything_cpu_s", of.yardstick.cpu},
          {"ticks", of.speed.ticks},
          {"plate_impulses", of.speed.plate_impulses},
          {"rod_impulses", of.speed.rod_impulses},
          {"plate_impulses_per_tick", per_tick(of.speed.plate_impulses)},
          {"rod_impulses_per_tick", per_tick(of.speed.rod_impulses)}};
}

/// Switches off every effect of the case that can be off, one at a time.
void measure_savings(const Case& everything, const Cache& cache, const Effort& effort, Report& report) {
  // few enough vibrations for the rods to be still where they would have been, often enough to make up for it
  constexpr int kFewPeriods = 4;
  constexpr int kOften = 3;
  const SteadyState state = cache(everything);
  const Contender all_on = contender(everything, state);
  report.json["impossible"] = Json::object();
  const auto measure = [&](const std::string& name, const Case& scene, const std::string& neutral) {
    try {
      if (const auto started = Simulation::start(scene.system()); !started) {
        throw Failure(ExitCode::kFailed, started.error().message);
      }
      const SteadyState own = cache(scene);
      ProgressLine progress("measuring without " + name);
      Json row{{"without", name}, {"neutral", neutral}, {"same_state", nullptr}};
      row["own_state"] = json_of(compare(contender(scene, own), all_on, effort.repeat, 0, effort.cpu));
      if (Simulation::resume(scene.system(), state.checkpoint)) {
        row["same_state"] = json_of(compare(contender(scene, state), all_on, kOften * effort.repeat, kFewPeriods, 0));
      } else {  // without the effect that state could not be
        row["same_state"] = row["own_state"];
        for (auto& [key, value] : row["same_state"].items()) value = nullptr;
      }
      report.json["rows"].push_back(std::move(row));
    } catch (const Failure& failure) {  // without a base, say, rods fall until they are too fast
      report.json["impossible"][name] = failure.what();
    }
  };
  // the same against itself: how far to trust the other figures
  measure("(nothing)", everything, "");
  for (const Effect& effect : all_effects()) {
    if (effect.switch_off == nullptr || !effect.is_on(everything.system())) continue;
    Case without = everything;
    effect.switch_off(without.plan.system);
    measure(std::string(effect.name), without, effect.why(without.system()));
  }
}

std::string effects_text(const Case& scene, const Effort& effort, const Json& report) {
  std::string text = fmt::format(
      R"({}, N = {}, dt = {:.10g} us; states after {:.10g} simulated seconds; best of {} repetitions

CPU time per rod-second without an effect, in % of that with everything on, taken in turn; errors are from the
scatter of single repetitions. Same state: the next 4 vibrations of the rods with everything on, which is what
it takes to compute the effect. Own state: after a warm-up without the effect, which also counts what its absence
makes of the rods. Impulses of rods with plates and with each other, per tick, and rates are of the own state.
)",
      scene.label(), scene.system().n_rods, 1e6 * scene.dt, scene.warm_up, effort.repeat);
  text += table(report.at("rows"), {{"without", "without"},
                                    {"same state %", "same_state/cpu_ratio", "{:.1f}", 100},
                                    {"+-", "same_state/cpu_ratio_error", "{:.1f}", 100},
                                    {"own state %", "own_state/cpu_ratio", "{:.1f}", 100},
                                    {"+-", "own_state/cpu_ratio_error", "{:.1f}", 100},
                                    {"rod-s/CPU-s", "own_state/rod_s_per_cpu_s", "{:.1f}"},
                                    {"plate/tick", "own_state/plate_impulses_per_tick", "{:.3g}"},
                                    {"rod-rod/tick", "own_state/rod_impulses_per_tick", "{:.3g}"},
                                    {"that is", "neutral"}});
  if (!report.at("impossible").empty()) text += "\nNot possible:\n";
  for (const auto& [effect, why] : report.at("impossible").items()) {
    text += fmt::format("{}: {}\n", effect, why.get<std::string>());
  }
  return text;
}

void draw_effects(const std::filesystem::path& folder, const Report& report) {
  const int n = static_cast<int>(report.rows().size());
  std::string script = plot_head("effects", {std::max(1100, 220 + 80 * n), 800}) + plot_axes("y");
  script += fmt::format(
      R"(set style fill solid 1
set boxwidth 0.38
set xtics rotate by 35 right scale 0 noenhanced
set bmargin 9
set logscale y
set yrange [20:*]
set xrange [-0.6:{}]
set key above
set ylabel 'CPU time without the effect (% of everything on)'
set arrow from graph 0,first 100 to graph 1,first 100 nohead linecolor '#999999' dashtype 2
plot 'effects.dat' using ($0-0.2):2:xtic(1) with boxes linecolor '#5ec962' title 'from the same state', \
     '' using ($0+0.2):4 with boxes linecolor '#3b528b' title 'from its own state', \
     '' using ($0-0.2):2:3 with yerrorbars pointtype 0 linecolor '#333333' notitle, \
     '' using ($0+0.2):4:5 with yerrorbars pointtype 0 linecolor '#333333' notitle
)",
      n - 0.4);
  const std::string data =
      plot_data(report.rows(), {{"effect left out; CPU time [% of everything on]:", "without"},
                                {"same state", "same_state/cpu_ratio", "", 100, "same_state/cpu_ratio_error"},
                                {"own state", "own_state/cpu_ratio", "", 100, "own_state/cpu_ratio_error"}});
  draw_plot(folder, "effects", data, script);
}

struct EffectsBench {
  CaseOptions scene{.side = 41.865};
  Effort effort{.cpu = 0.5};
  Cache cache;
  Output output;

  void declare(CLI::App& app) {
    scene.declare(app);
    add_number(app, "--cpu", effort.cpu, "S", {1e-3, 1e3}, "CPU time of one timed stretch, about");
    add_number(app, "--repeat", effort.repeat, "N", {1, 1000}, "Repetitions, of which the best counts");
    cache.declare(app);
    output.declare(app);
  }

  ExitCode run() const {
    const Case everything = scene.read();
    Report report("effects", "effects");
    report.json["warm_up_s"] = everything.warm_up;
    report.json["repeat"] = effort.repeat;
    report.json.update(json_of(everything));
    measure_savings(everything, cache, effort, report);
    report.text += effects_text(everything, effort, report.json);
    output.give(report);
    if (!output.folder.empty()) draw_effects(output.folder, report);
    return ExitCode::kOk;
  }
};

}  // namespace

void add_effects(CLI::App& app, Work& work) {
  add_bench<EffectsBench>(app, work, "effects", "CPU time that each effect of the physics costs", kEffectsFooter);
}

}  // namespace shaken::bench
