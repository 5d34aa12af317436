#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "bench/case.h"
#include "bench/report.h"

namespace shaken::bench {

/// How long and how often to measure.
struct Effort {
  double cpu = 1.5;  ///< CPU time of one timed stretch, about [s]
  int repeat = 5;

  /// Adds --cpu and --repeat.
  void declare(CLI::App& app);
};

/// What was done in a timed stretch of a case, and how long it took in each repetition.
struct StepperSpeed {
  Tick ticks = 0;            ///< length of the stretch
  std::vector<double> cpu;   ///< CPU time of each repetition, all threads together [s]
  std::vector<double> wall;  ///< and on the wall [s]
  double rod_seconds = 0;    ///< simulated in the stretch
  std::int64_t plate_impulses = 0;
  std::int64_t wall_impulses = 0;
  std::int64_t rod_impulses = 0;  ///< between rods
  double bytes_per_rod = 0;       ///< memory of state and stepper
  double max_overlap = 0;         ///< deepest since the start of the run [mm]

  double best_cpu() const { return *std::min_element(cpu.begin(), cpu.end()); }  ///< least disturbed by other programs
  double best_wall() const { return *std::min_element(wall.begin(), wall.end()); }
  double spread() const;  ///< median CPU time over the best
  double wall_spread() const;
  double rate() const { return rod_seconds / best_cpu(); }  ///< rod-seconds per CPU-second
  std::int64_t impulses() const { return plate_impulses + wall_impulses + rod_impulses; }
};

/// How many ticks take about `cpu` seconds by `stepper`: whole vibrations if it is at least one, as speed changes with
/// the plates' phase.
Tick ticks_for(double cpu, const Case& of, const SteadyState& state, StepperKind stepper);

/// Steps on by `ticks` and adds one repetition to `speed`; everything else in it is set anew.
void time_stretch(Simulation& simulation, const Case& of, Tick ticks, StepperSpeed& speed);

/// One of several ways to simulate whose speeds are compared.
struct Contender {
  Case scene;
  SteadyState state;  ///< where each repetition begins
  StepperKind stepper = StepperKind::kScheduled;
  int threads = 1;
  Tick warm_up = 1;        ///< not timed: lists and schedules are built
  Tick ticks = 0;          ///< timed
  StepperSpeed speed{};    ///< found
  std::uint64_t hash = 0;  ///< of the state after them
};

/// The scheduled stepper, warmed up for a vibration and timed for at least another, about `cpu` seconds.
Contender contender(const Case& scene, const SteadyState& state, double cpu);

/// Times all contenders, one after the other, so many times; `what` is shown meanwhile.
void time_in_turn(const std::string& what, std::vector<Contender>& contenders, int repeat);

/// CPU time per rod-second of one contender over that of another, timed in turn with it: of the best repetitions, with
/// an error from the scatter of the ratios of single ones, which is NaN for one.
Estimate cpu_ratio(const StepperSpeed& of, const StepperSpeed& other);

/// As members of a report's row.
Json json_of(const Case& scene);
Json json_of(const StepperSpeed& speed);

}  // namespace shaken::bench
