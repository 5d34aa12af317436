// What each effect of the physics costs: the CPU time without it against that with everything on.
#include <fmt/format.h>

#include <functional>

#include "bench/bench.h"
#include "bench/timing.h"
#include "scene/deciding_key.h"
#include "sim/effects/registry.h"

namespace shaken::bench {
namespace {

constexpr const char* kEffectsFooter =
    R"(Every effect that can be off is switched off, one at a time (docs/effects.md). CPU times are compared from one and
the same state, which tells what it takes to compute the effect, and from a state that came about without it, which
tells what a user gains: mostly nothing, as rods without friction or bounce collide more often. What effects do to the
physics the runs of configs/effects.json tell.

Examples:
  shaken bench effects                                      527 rods of 4.5 mm at area fraction 0.75
  shaken bench effects --area-fraction 0.45 --out effects   fewer; effects/effects.csv, .json and .png
  shaken bench effects --warm-up 5 --repeat 9               in the steady state of each, with smaller errors
  shaken bench effects --scene scene.json                   the effects of a scene of yours

Exit codes: 0 done, 1 something failed, 2 bad input.)";

/// The effect's case against the one with everything on, as they were timed in turn.
Json comparison(const Contender& without, const Contender& everything) {
  const Estimate ratio = cpu_ratio(without.speed, everything.speed);
  Json of{{"cpu_ratio", ratio.value}, {"cpu_ratio_error", ratio.sem}};
  of.update(json_of(without.speed));
  return of;
}

/// Calls `measure` with each effect of the case that can be off, its neutral value and the case without it; first with
/// the case as it is. Why one failed (without a base, say, rods fall until they are too fast) goes into "impossible".
void switch_off_in_turn(const Case& everything, Report& report,
                        const std::function<void(const std::string&, const Case&, const std::string&)>& measure) {
  report.json["impossible"] = Json::object();
  const auto try_to = [&](const std::string& name, const Case& scene, const std::string& neutral) {
    try {
      measure(name, scene, neutral);
    } catch (const Failure& failure) {
      report.json["impossible"][name] = failure.what();
    }
  };
  try_to("(nothing)", everything, "");
  for (const Effect& effect : all_effects()) {
    if (effect.switch_off == nullptr || !effect.is_on(everything.system())) continue;
    Case without = everything;
    effect.switch_off(without.plan.system);
    try_to(std::string(effect.name), without, scene::deciding_key(without.plan, effect.keys));
  }
}

/// CPU times.
void measure_savings(const Case& everything, const Cache& cache, const Effort& effort, Report& report) {
  // few enough vibrations for the rods to be still where they would have been, often enough to make up for it
  constexpr int kFewPeriods = 4;
  constexpr int kOften = 3;
  const Contender all_on = contender(everything, cache(everything), effort.cpu);
  // the first, of the same against itself, says how far to trust the other figures
  switch_off_in_turn(everything, report, [&](const std::string& name, const Case& scene, const std::string& neutral) {
    const auto timed = [&](const Contender& of, const Contender& other, int repeat) {
      std::vector<Contender> both{other, of};
      time_in_turn("measuring without " + name, both, repeat);
      return comparison(both[1], both[0]);
    };
    value_or_fail(Simulation::start(scene.system()));
    Json row{{"without", name}, {"neutral", neutral}};
    row["own_state"] = timed(contender(scene, cache(scene), effort.cpu), all_on, effort.repeat);
    if (Simulation::resume(scene.system(), all_on.state.checkpoint)) {
      Contender briefly = all_on;
      briefly.warm_up = 1;
      briefly.ticks = kFewPeriods * everything.period_ticks();
      Contender without = briefly;
      without.scene = scene;
      row["same_state"] = timed(without, briefly, kOften * effort.repeat);
    }  // or else without the effect that state could not be
    report.json["rows"].push_back(std::move(row));
  });
}

std::string impossible_text(const Json& report) {
  std::string text = report.at("impossible").empty() ? "" : "\nNot possible:\n";
  for (const auto& [effect, why] : report.at("impossible").items()) {
    text += fmt::format("{}: {}\n", effect, why.get<std::string>());
  }
  return text;
}

std::string effects_text(const Case& scene, const Effort& effort, const Json& report) {
  std::string text = fmt::format(
      R"({}, N = {}, dt = {:.10g} us; states after {:.10g} simulated seconds; best of {} repetitions

CPU time per rod-second without an effect, in % of that with everything on, taken in turn; errors are from the
scatter of single repetitions. Same state: the next 4 vibrations of the rods with everything on, which is what
it takes to compute the effect. Own state: after a warm-up without the effect, which also counts what its absence
makes of the rods. Impulses from plates and between rods, per rod and simulated second, and rates are of the own
state.
)",
      scene.label, scene.n_rods(), 1e6 * scene.dt, scene.warm_up, effort.repeat);
  text += table(report.at("rows"), {{"without", "without"},
                                    {"same state %", "same_state/cpu_ratio", "{:.1f}", 100},
                                    {"+-", "same_state/cpu_ratio_error", "{:.1f}", 100},
                                    {"own state %", "own_state/cpu_ratio", "{:.1f}", 100},
                                    {"+-", "own_state/cpu_ratio_error", "{:.1f}", 100},
                                    {"rod-s/CPU-s", "own_state/rod_s_per_cpu_s", "{:.1f}"},
                                    {"plates", "own_state/impulses_per_rod_second/plates", "{:.0f}"},
                                    {"rods", "own_state/impulses_per_rod_second/rods", "{:.0f}"},
                                    {"that is", "neutral"}});
  return text + impossible_text(report);
}

struct EffectsBench {
  CaseOptions rods{.side = 41.865};
  std::string scene;  ///< a file, in place of these rods; empty: none
  Effort effort{.cpu = 0.5};
  Cache cache;
  Output output;

  void declare(CLI::App& app) {
    rods.declare(app);
    CLI::Option* file = add_path(app, "--scene", scene, "FILE", "A scene of yours; how long it runs is left out");
    for (const char* name : {"--length", "--area-fraction", "--side"}) file->excludes(app.get_option(name));
    effort.declare(app);
    cache.declare(app);
    output.declare(app);
  }

  Case read() const { return scene.empty() ? rods.read() : read_case(scene, rods.warm_up); }

  ExitCode run() const {
    const Case everything = read();
    Report report("effects", "effects");
    report.json["warm_up_s"] = everything.warm_up;
    report.json["repeat"] = effort.repeat;
    report.json.update(json_of(everything));
    measure_savings(everything, cache, effort, report);
    report.text += effects_text(everything, effort, report.json);
    output.give(report);
    return ExitCode::kOk;
  }
};

}  // namespace

void add_effects(CLI::App& app, Work& work) {
  add_bench<EffectsBench>(app, work, "effects", "What each effect of the physics costs", kEffectsFooter);
}

}  // namespace shaken::bench
