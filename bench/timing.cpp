#include "bench/timing.h"

#include <cmath>

#include "base/clock.h"
#include "base/progress_line.h"
#include "bench/bench.h"

namespace shaken::bench {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

}  // namespace

void Effort::declare(CLI::App& app) {
  add_number(app, "--cpu", cpu, "S", {1e-3, 1e3}, "CPU time of one timed stretch, about");
  add_number(app, "--repeat", repeat, "N", {1, 1000}, "Repetitions, of which the best counts");
}

double StepperSpeed::spread() const { return median(cpu) / best_cpu(); }

double StepperSpeed::wall_spread() const { return median(wall) / best_wall(); }

Tick ticks_for(double cpu, const Case& of, const SteadyState& state, StepperKind stepper) {
  Simulation simulation = resumed(of, state, stepper);
  advance(simulation, 1);  // builds lists and schedules
  const Tick period = of.period_ticks();
  const double start = cpu_seconds();
  Tick done = 0;
  double taken = 0;
  for (Tick stride = std::max<Tick>(1, period / 64); taken < 0.1 * cpu; stride *= 2) {
    advance(simulation, stride);
    done += stride;
    taken = cpu_seconds() - start;
  }
  const double ticks = static_cast<double>(done) * cpu / taken;
  const double periods = std::round(ticks / static_cast<double>(period));
  return periods >= 1 ? static_cast<Tick>(periods) * period : std::max<Tick>(1, std::llround(ticks));
}

void time_stretch(Simulation& simulation, const Case& of, Tick ticks, StepperSpeed& speed) {
  const Counters before = simulation.world().counters;
  const double wall = wall_seconds();
  const double cpu = cpu_seconds();
  advance(simulation, ticks);
  speed.cpu.push_back(cpu_seconds() - cpu);
  speed.wall.push_back(wall_seconds() - wall);
  const Counters after = simulation.world().counters;
  speed.ticks = ticks;
  speed.rod_seconds = of.rod_seconds(ticks);
  speed.plate_impulses =
      after.impulses_rod_base + after.impulses_rod_lid - before.impulses_rod_base - before.impulses_rod_lid;
  speed.wall_impulses = after.impulses_rod_wall - before.impulses_rod_wall;
  speed.rod_impulses = after.impulses_rod_rod - before.impulses_rod_rod;
  speed.bytes_per_rod = static_cast<double>(simulation.bytes()) / of.n_rods();
  speed.max_overlap = after.max_overlap();
}

Contender contender(const Case& scene, const SteadyState& state, double cpu) {
  const Tick period = scene.period_ticks();
  return {.scene = scene,
          .state = state,
          .warm_up = period,
          .ticks = std::max(ticks_for(cpu, scene, state, StepperKind::kScheduled), period)};
}

void time_in_turn(const std::string& what, std::vector<Contender>& contenders, int repeat) {
  ProgressLine progress(what);
  double done = 0;
  for (int repetition = 0; repetition < repeat; ++repetition) {
    for (Contender& of : contenders) {
      Simulation simulation = resumed(of.scene, of.state, of.stepper);
      simulation.use_threads(of.threads);
      simulation.share_where_faster(wall_seconds);
      advance(simulation, of.warm_up);
      time_stretch(simulation, of.scene, of.ticks, of.speed);
      of.hash = simulation.state_hash();
      progress.show(++done / (repeat * static_cast<double>(contenders.size())));
    }
  }
}

Estimate cpu_ratio(const StepperSpeed& of, const StepperSpeed& other) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < of.cpu.size(); ++k) {
    ratios.push_back(of.cpu[k] / of.rod_seconds / (other.cpu[k] / other.rod_seconds));
  }
  return {other.rate() / of.rate(), mean_of_samples(ratios).sem};
}

Json json_of(const Case& scene) {
  return {{"length_mm", scene.length},
          {"n_beads", scene.system().rod.n_beads},
          {"area_fraction", scene.area_fraction},
          {"side_mm", scene.side},
          {"n_rods", scene.n_rods()},
          {"dt_s", scene.dt}};
}

Json json_of(const StepperSpeed& speed) {
  const auto per_rod_second = [&](std::int64_t n) { return static_cast<double>(n) / speed.rod_seconds; };
  return {{"rod_s_per_cpu_s", speed.rate()},
          {"spread", speed.spread()},
          {"rod_s_per_wall_s", speed.rod_seconds / speed.best_wall()},
          {"wall_spread", speed.wall_spread()},
          {"cpu_s", speed.cpu},
          {"wall_s", speed.wall},
          {"ticks", speed.ticks},
          {"rod_seconds", speed.rod_seconds},
          {"impulses_per_rod_second",
           {{"plates", per_rod_second(speed.plate_impulses)},
            {"walls", per_rod_second(speed.wall_impulses)},
            {"rods", per_rod_second(speed.rod_impulses)}}},
          {"impulses_per_cpu_s", static_cast<double>(speed.impulses()) / speed.best_cpu()},
          {"ns_per_impulse", 1e9 * speed.best_cpu() / static_cast<double>(speed.impulses())},
          {"bytes_per_rod", speed.bytes_per_rod}};
}

}  // namespace shaken::bench
