#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bench/bench.h"
#include "bench/kinds.h"
#include "bench/rates.h"

namespace shaken::bench {
namespace {

constexpr const char* kSpeedFooter = R"(A steady state is simulated once (progress on stderr) and kept in the cache.

Examples:
  shaken bench speed                                    rods of 4.5 and 2.5 mm in a box of 41.865 mm
  shaken bench speed --quick                            about a minute, not yet in the steady state
  shaken bench speed --full --out speed                 24 scenes; speed/speed.csv, .json and .png
  shaken bench speed --length 4.5,2.5 --area-fraction 0.75 --side 83.73
  shaken bench speed --scaling n --out speed            cost per rod from 500 to 18,000 rods
  shaken bench speed --scaling dt                       cost of other steps than the paper's
  shaken bench speed --kinds --out speed                spheres, polar rods, side walls and others, beside each other
  shaken bench speed --threads 1,2,4 --area-fraction 0.75 --side 83.73

Exit codes: 0 done, 1 the steppers' states differ or something failed, 2 bad input.)";

constexpr double kSmallSide = 41.865;  // [mm]; half the paper's box

struct SpeedBench {
  std::vector<double> lengths, fractions, sides;
  std::vector<int> threads;
  std::optional<double> warm_up, cpu;
  std::optional<int> repeat;
  std::string scaling;
  bool full = false, quick = false, kinds = false;
  Cache cache;
  Output output;

  void declare(CLI::App& app) {
    const std::array lists{
        add_number(app, "--length", lengths, "LIST", limits_of("rods.length"), "Rod lengths [mm]"),
        add_number(app, "--area-fraction", fractions, "LIST", limits_of("rods.area_fraction"), "Area fractions"),
        add_number(app, "--side", sides, "LIST", limits_of("box.side"), "Sides of the box [mm]")};
    CLI::Option* all =
        app.add_flag("--full", full, "All 24 scenes: 2 lengths, 4 area fractions, 3 boxes (an hour the first time)");
    app.add_flag("--quick", quick, "Shorter warm-up and stretches: about a minute")->excludes(all);
    add_number(
        app, "--warm-up", warm_up, "S", kWarmUps,
        "Simulated seconds before measuring; 5; 0.5 with --quick, --scaling or --kinds; 0.1 with --quick --kinds");
    add_number(app, "--cpu", cpu, "S", {1e-3, 1e3},
               "CPU time of one timed stretch, about; 1.5, or 0.5 with --quick; of --kinds 0.7, or 0.1");
    add_number(app, "--repeat", repeat, "N", {1, 1000}, "Repetitions, of which the best counts; 5, or 3 with --quick");
    CLI::Option* series =
        app.add_option("--scaling", scaling, "Instead: cost per rod against the number of rods, or the step");
    series->type_name("n|dt")->check(CLI::IsMember({"n", "dt"}).description(""))->excludes(all);
    CLI::Option* by_threads =
        add_number(app, "--threads", threads, "LIST", {1, 64}, "Instead: wall time by so many threads");
    by_threads->excludes(series);
    CLI::Option* by_kind = app.add_flag("--kinds", kinds, "Instead: speed by kind of scene");
    by_kind->excludes(all)->excludes(series)->excludes(by_threads);
    for (CLI::Option* list : lists) by_kind->excludes(list);
    cache.declare(app);
    output.declare(app);
  }

  Conditions conditions() const {
    const bool brief = quick || kinds || !scaling.empty();
    const double stretch = kinds ? (quick ? 0.1 : 0.7) : quick ? 0.5 : 1.5;
    const double before = kinds && quick ? 0.1 : brief ? 0.5 : Conditions::kSteady;
    return {{cpu.value_or(stretch), repeat.value_or(quick ? 3 : 5)}, warm_up.value_or(before)};
  }

  /// What was asked for, or else these.
  static std::vector<double> given(const std::vector<double>& asked, const std::vector<double>& otherwise) {
    return asked.empty() ? otherwise : asked;
  }

  std::vector<Case> scenes() const {
    const double after = conditions().warm_up;
    std::vector<Case> scenes;
    for (const double side : given(sides, full ? std::vector{kSmallSide, 83.73, 167.46} : std::vector{kSmallSide})) {
      for (const double length : given(lengths, full ? std::vector{4.5, 2.5} : std::vector{4.5})) {
        for (const double fraction : given(fractions, {0.45, 0.60, 0.75, 0.85})) {
          scenes.push_back(make_case(length, fraction, side, kPaperStep, after));
        }
      }
    }
    const bool any_list = !lengths.empty() || !fractions.empty() || !sides.empty();
    if (!any_list && !full) scenes.push_back(make_case(2.5, 0.60, kSmallSide, kPaperStep, after));
    return scenes;
  }

  /// The scenes of a series, which take turns.
  std::vector<Case> series(Comparison of) const {
    const double after = conditions().warm_up;
    std::vector<Case> series;
    if (of == Comparison::kKinds) {
      for (const SceneKind& kind : scene_kinds()) series.push_back(case_of(kind, after));
      return series;
    }
    if (lengths.size() > 1 || fractions.size() > 1 || (of == Comparison::kStep && sides.size() > 1)) {
      throw Failure(ExitCode::kBadInput, fmt::format("--scaling {} takes one value each of --length, --area-fraction{}",
                                                     scaling, of == Comparison::kStep ? " and --side" : ""));
    }
    const auto add = [&](double side, double dt) {
      series.push_back(make_case(given(lengths, {4.5})[0], given(fractions, {0.75})[0], side, dt, after));
    };
    if (of == Comparison::kRods) {
      for (const double side : given(sides, {kSmallSide, 83.73, 167.46, 244})) add(side, kPaperStep);
    } else {
      for (const double dt : {kPaperStep, 32e-6, 16e-6, 8e-6, 2e-6, 1e-6}) add(given(sides, {kSmallSide})[0], dt);
    }
    return series;
  }

  Contender contender_on(const Case& scene) const { return contender(scene, cache(scene), conditions().effort.cpu); }

  Json measure_series(Comparison of) const {
    std::vector<Contender> contenders;
    for (const Case& scene : series(of)) contenders.push_back(contender_on(scene));
    time_in_turn("measuring", contenders, conditions().effort.repeat);
    Json rows = Json::array();
    for (const Contender& one : contenders) rows.push_back(rate_row(one, contenders.front(), count_work(one)));
    return rows;
  }

  Json measure_threads() const {
    Json rows = Json::array();
    for (const Case& scene : scenes()) {
      std::vector<Contender> by(threads.size(), contender_on(scene));
      for (std::size_t k = 0; k < threads.size(); ++k) by[k].threads = threads[k];
      time_in_turn("measuring threads on " + scene.label, by, conditions().effort.repeat);
      const CountedWork work = count_work(by.front());
      for (const Contender& of : by) rows.push_back(threads_row(of, by.front(), work));
    }
    return rows;
  }

  Json measure_steppers() const {
    const Effort effort = conditions().effort;
    Json rows = Json::array();
    for (const Case& scene : scenes()) {
      Contender scheduled = contender_on(scene);
      // One tick builds the lists; from there on the reference is timed, and the scheduled stepper warms up.
      Contender reference = scheduled;
      reference.stepper = StepperKind::kReference;
      reference.warm_up = 1;
      reference.ticks = ticks_for(effort.cpu, scene, reference.state, reference.stepper);
      const Tick compared_ticks = reference.warm_up + reference.ticks;
      scheduled.warm_up = std::max(scheduled.warm_up, compared_ticks);
      std::vector<Contender> both{reference, scheduled};
      time_in_turn("measuring " + scene.label, both, effort.repeat);
      Simulation compared = resumed(scene, scheduled.state, scheduled.stepper);
      advance(compared, compared_ticks);
      rows.push_back(steppers_row(both[1], both[0], count_work(both[1]), compared_ticks, compared.state_hash()));
    }
    return rows;
  }

  ExitCode run() const {
    const Comparison of = kinds              ? Comparison::kKinds
                          : scaling == "n"   ? Comparison::kRods
                          : scaling == "dt"  ? Comparison::kStep
                          : !threads.empty() ? Comparison::kThreads
                                             : Comparison::kSteppers;
    const Report report = rates_report(conditions(), of,
                                       of == Comparison::kSteppers  ? measure_steppers()
                                       : of == Comparison::kThreads ? measure_threads()
                                                                    : measure_series(of));
    output.give(report);
    if (of == Comparison::kThreads) check_states(report, "the number of threads changed the trajectory");
    if (of == Comparison::kSteppers) check_states(report, "the steppers' states differ");
    return ExitCode::kOk;
  }
};

}  // namespace

void add_speed(CLI::App& app, Work& work) {
  add_bench<SpeedBench>(app, work, "speed", "Simulated rod-seconds per CPU-second, and what they are spent on",
                        kSpeedFooter);
}

}  // namespace shaken::bench
