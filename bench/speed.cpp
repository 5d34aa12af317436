// SPDX-License-Identifier: MIT
#include "bench/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/clock.h"
#include "bench/bench.h"

namespace shaken::bench {

Report report_under(const Conditions& conditions, const std::string& file_name, const std::string& bench) {
  Report report(file_name, bench);
  report.json["warm_up_s"] = conditions.warm_up;
  report.json["steady"] = conditions.steady();
  report.json["repeat"] = conditions.effort.repeat;
  report.text += fmt::format(
      "state after {:.10g} simulated seconds{}; {}\n", conditions.warm_up,
      conditions.steady() ? "" : fmt::format(" (NOT the steady state: that takes {:.10g})", Conditions::kSteady),
      conditions.effort.repeat == 1 ? "one run" : fmt::format("best of {} repetitions", conditions.effort.repeat));
  return report;
}

std::vector<Column> scene_columns(const std::vector<Column>& more) {
  std::vector<Column> columns{{"l mm", "length_mm", "{:.10g}"},
                              {"phi", "area_fraction", "{:.10g}"},
                              {"L mm", "side_mm", "{:.10g}"},
                              {"N", "n_rods"}};
  columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

void check_states(const Report& report, const std::string& what) {
  for (const Json& row : report.rows()) {
    if (row.at("hashes_equal").get<bool>()) continue;
    const std::string scene = label_of(row.at("length_mm"), row.at("area_fraction"), row.at("side_mm"));
    const Json& ticks = member_of(row, "compared_ticks");
    const std::string when = ticks.is_null() ? "" : fmt::format(" after {} ticks", ticks.get<Tick>());
    throw Failure(ExitCode::kFailed, scene + ": " + what + when);
  }
}

Json phase_shares(const std::array<double, kPhases>& phases, double cpu) {
  Json shares;
  double other = 1;
  for (std::size_t p = 0; p < kPhases; ++p) {
    const double share = phases[p] / cpu;
    shares[kPhaseNames[p]] = share;
    other -= share;
  }
  shares["other"] = std::max(0.0, other);  // < 0: the clock's error
  return shares;
}

std::vector<Column> phase_columns() {
  std::vector<Column> columns;
  columns.reserve(kPhases + 1);
  for (const char* name : kPhaseNames) {
    std::string title = name;
    std::replace(title.begin(), title.end(), '_', ' ');
    columns.push_back({std::move(title), std::string("phase_shares/") + name, "{:.1f}", 100});
  }
  return columns;
}

std::string phases_text(const Json& rows, const std::vector<Column>& scene) {
  std::vector<Column> columns = scene;
  for (Column& phase : phase_columns()) columns.push_back(std::move(phase));
  columns.push_back({"other", "phase_shares/other", "{:.1f}", 100});
  return "\nWhere the scheduled stepper's CPU time goes, in % (from a run of its own, without the clock's time).\n" +
         table(rows, columns);
}

SceneSpeed measure_scene(const Case& scene, const SteadyState& state, const Effort& effort) {
  // One tick builds the lists; from there on the reference is timed, and the scheduled stepper settles.
  const Contender reference{.scene = scene,
                            .state = state,
                            .stepper = StepperKind::kReference,
                            .ticks = ticks_for(effort.cpu, scene, state, StepperKind::kReference)};
  Contender scheduled = contender(scene, state, effort.cpu);
  const Tick compared_ticks = reference.shorten_bound + reference.ticks;
  scheduled.shorten_bound = std::max(scheduled.shorten_bound, compared_ticks);
  std::vector<Contender> both{reference, scheduled};
  time_in_turn("measuring " + scene.label, both, effort.repeat);
  SceneSpeed speed{both[1], both[0], compared_ticks, 0, {}, 0, {}};

  Simulation timed = resumed(scene, state, StepperKind::kScheduled);
  advance(timed, compared_ticks);
  speed.scheduled_hash = timed.state_hash();
  advance(timed, scheduled.shorten_bound - compared_ticks);
  speed.bounds = measure_lower_bounds(timed.world());
  timed.time_phases(thread_cpu_seconds_without_readings);
  const double start = thread_cpu_seconds_without_readings();
  advance(timed, scheduled.ticks);
  speed.phases_cpu = thread_cpu_seconds_without_readings() - start;
  for (std::size_t p = 0; p < kPhases; ++p) speed.phases[p] = timed.phase_times().seconds(static_cast<Phase>(p));
  return speed;
}

namespace {

Json speed_row(const SceneSpeed& scene) {
  const StepperSpeed& scheduled = scene.scheduled.speed;
  Json row = json_of(scene.scheduled.scene);
  row["scheduled"] = json_of(scheduled);
  row["reference"] = json_of(scene.reference.speed);
  row["scheduled"]["state_hash"] = fmt::format("{:016x}", scene.scheduled_hash);
  row["reference"]["state_hash"] = fmt::format("{:016x}", scene.reference.hash);
  row["ratio"] = scheduled.rate() / scene.reference.speed.rate();
  row["compared_ticks"] = scene.compared_ticks;
  row["hashes_equal"] = scene.scheduled_hash == scene.reference.hash;
  row["phase_shares"] = phase_shares(scene.phases, scene.phases_cpu);
  row["lower_bounds"] = {{"plate_impulse_ns", 1e9 * scene.bounds.plate_impulse},
                         {"rod_impulse_ns", 1e9 * scene.bounds.rod_impulse},
                         {"state_access_ns", 1e9 * scene.bounds.state_access},
                         {"impulses_alone_share", scene.bounds.impulses_alone(scheduled) / scheduled.best_cpu()},
                         {"memory_alone_share", scene.bounds.memory_alone(scheduled) / scheduled.best_cpu()}};
  return row;
}

}  // namespace

Report speed_report(const Conditions& conditions, const std::vector<SceneSpeed>& scenes) {
  Report report = report_under(conditions, "speed", "speed");
  for (const SceneSpeed& scene : scenes) report.json["rows"].push_back(speed_row(scene));
  report.text +=
      "\nSimulated rod-seconds per CPU-second by either stepper, in turn; spread is median over best CPU time of\n"
      "the scheduled and of the reference stepper; same state: bitwise, after as many ticks by either.\n" +
      table(report.rows(), scene_columns({{"scheduled", "scheduled/rod_s_per_cpu_s", "{:.1f}"},
                                          {"reference", "reference/rod_s_per_cpu_s", "{:.2f}"},
                                          {"ratio", "ratio", "{:.1f}"},
                                          {"spread", "scheduled/spread", "{:.3f}"},
                                          {"spread", "reference/spread", "{:.3f}"},
                                          {"impulses/CPU-s", "scheduled/impulses_per_cpu_s", "{:.3g}"},
                                          {"ns/impulse", "scheduled/ns_per_impulse", "{:.0f}"},
                                          {"bytes/rod", "scheduled/bytes_per_rod", "{:.0f}"},
                                          {"same state", "hashes_equal"}}));
  report.text += phases_text(report.rows(), scene_columns({}));
  report.text +=
      "\nLower bounds: the share of the scheduled stepper's time that its impulses alone take, if finding contacts\n"
      "were free, and the share that reading and writing the states of the rods hit takes, if computing were.\n" +
      table(report.rows(), scene_columns({{"ns/plate impulse", "lower_bounds/plate_impulse_ns", "{:.0f}"},
                                          {"ns/rod-rod impulse", "lower_bounds/rod_impulse_ns", "{:.0f}"},
                                          {"ns/state", "lower_bounds/state_access_ns", "{:.1f}"},
                                          {"impulses %", "lower_bounds/impulses_alone_share", "{:.1f}", 100},
                                          {"memory %", "lower_bounds/memory_alone_share", "{:.1f}", 100}}));
  return report;
}

namespace {

constexpr const char* kSpeedFooter = R"(A steady state is simulated once (progress on stderr) and kept in the cache.

Examples:
  shaken bench speed                                    rods of 4.5 and 2.5 mm in a box of 41.865 mm
  shaken bench speed --quick                            about a minute, not yet in the steady state
  shaken bench speed --full --out speed                 24 scenes; speed/speed.csv, .json and .png
  shaken bench speed --length 4.5,2.5 --area-fraction 0.75 --side 83.73
  shaken bench speed --scaling n --out speed            cost per rod from 500 to 18,000 rods
  shaken bench speed --scaling dt                       cost of a finer step
  shaken bench speed --count                            what a rod-second consists of: visits, searches, bounds
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
  bool full = false, quick = false, count = false, kinds = false;
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
    CLI::Option* counts =
        app.add_flag("--count", count, "Instead: what a rod-second consists of, and how good the bounds on pairs are");
    counts->excludes(series)->excludes(by_threads);
    CLI::Option* by_kind = app.add_flag("--kinds", kinds, "Instead: speed by kind of scene");
    by_kind->excludes(all)->excludes(series)->excludes(by_threads)->excludes(counts);
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

  ExitCode run_scaling() const {
    const Scaling of = scaling == "n" ? Scaling::kRods : Scaling::kStep;
    if (lengths.size() > 1 || fractions.size() > 1 || (of == Scaling::kStep && sides.size() > 1)) {
      throw Failure(ExitCode::kBadInput, fmt::format("--scaling {} takes one value each of --length, --area-fraction{}",
                                                     scaling, of == Scaling::kStep ? " and --side" : ""));
    }
    std::vector<Case> series;
    const auto add = [&](double side, double dt) {
      series.push_back(
          make_case(given(lengths, {4.5})[0], given(fractions, {0.75})[0], side, dt, conditions().warm_up));
    };
    if (of == Scaling::kRods) {
      for (const double side : given(sides, {kSmallSide, 83.73, 167.46, 244})) add(side, kPaperStep);
    } else {
      for (const double dt : {8e-6, 4e-6, 2e-6, 1e-6}) add(given(sides, {kSmallSide})[0], dt);
    }
    std::vector<Contender> contenders;
    for (const Case& scene : series) contenders.push_back(contender(scene, cache(scene), conditions().effort.cpu));
    time_in_turn("measuring", contenders, conditions().effort.repeat);
    const Report report = scaling_report(conditions(), of, contenders);
    output.give(report);
    return ExitCode::kOk;
  }

  ExitCode run_threads() const {
    std::vector<ThreadsSpeed> measured;
    for (const Case& scene : scenes()) {
      const Contender by_one = contender(scene, cache(scene), conditions().effort.cpu);
      ThreadsSpeed& speed = measured.emplace_back();
      speed.by.assign(threads.size(), by_one);
      for (std::size_t k = 0; k < threads.size(); ++k) speed.by[k].threads = threads[k];
      time_in_turn("measuring threads on " + scene.label, speed.by, conditions().effort.repeat);
      speed.serial = measure_serial_share(by_one);
    }
    const Report report = threads_report(conditions(), measured);
    output.give(report);
    check_states(report, "the number of threads changed the trajectory");
    return ExitCode::kOk;
  }

  ExitCode run_count() const {
    std::vector<CountedWork> counted;
    for (const Case& scene : scenes())
      counted.push_back(measure_work(contender(scene, cache(scene), conditions().effort.cpu)));
    Conditions once = conditions();
    once.effort.repeat = 1;
    output.give(count_report(once, counted));
    return ExitCode::kOk;
  }

  ExitCode run_kinds() const {
    std::vector<Contender> contenders;
    for (const SceneKind& kind : scene_kinds()) {
      const Case scene = case_of(kind, conditions().warm_up);
      contenders.push_back(contender(scene, cache(scene), conditions().effort.cpu));
    }
    const Report report = kinds_report(conditions(), measure_kinds(std::move(contenders), conditions().effort.repeat));
    output.give(report);
    return ExitCode::kOk;
  }

  ExitCode run() const {
    if (kinds) return run_kinds();
    if (count) return run_count();
    if (!scaling.empty()) return run_scaling();
    if (!threads.empty()) return run_threads();
    std::vector<SceneSpeed> measured;
    for (const Case& scene : scenes()) measured.push_back(measure_scene(scene, cache(scene), conditions().effort));
    const Report report = speed_report(conditions(), measured);
    output.give(report);
    check_states(report, "the steppers' states differ");
    return ExitCode::kOk;
  }
};

}  // namespace

void add_speed(CLI::App& app, Work& work) {
  add_bench<SpeedBench>(app, work, "speed", "Simulated rod-seconds per CPU-second, and what they are spent on",
                        kSpeedFooter);
}

}  // namespace shaken::bench
