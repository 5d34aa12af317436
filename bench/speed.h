// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/pairs/bounds_in_use.h"
#include "bench/report.h"
#include "bench/timing.h"

namespace shaken::bench {

/// How figures of speed came about.
struct Conditions {
  Effort effort;
  double warm_up = 0;  ///< [s]
  /// Shorter than this, the rods still stand much as they were placed: figures are then not of the steady state.
  static constexpr double kSteady = 5.0;
  bool steady() const { return warm_up >= kSteady; }
};

/// With the conditions, but no rows yet.
Report report_under(const Conditions& conditions, const std::string& file_name, const std::string& bench);
/// What a scene is, at the beginning of each line of a table, and these columns.
std::vector<Column> scene_columns(const std::vector<Column>& more);
/// Throws Failure, "SCENE: WHAT after 1250 ticks", for the first row in which states that must be equal are not.
void check_states(const Report& report, const std::string& what);

/// The share of `cpu` [s] that each phase [s] took, and the rest as "other".
Json phase_shares(const std::array<double, kPhases>& phases, double cpu);
/// The phases' as columns in %, if these are the row's member "phase_shares".
std::vector<Column> phase_columns();
/// A table of these, and of the rest, whose lines begin with the columns `scene`.
std::string phases_text(const Json& rows, const std::vector<Column>& scene);

/// Times that no stepper of this model can go below, measured on the rods of one state [s].
struct LowerBounds {
  double plate_impulse = 0;  ///< of one impulse from a plate: pose, motion, impulse and the new flight
  double rod_impulse = 0;    ///< of one impulse between two rods: the same for both
  double state_access = 0;   ///< of reading and writing one rod's state at a random place, computing nothing

  /// What is left if finding contacts costs nothing [s].
  double impulses_alone(const StepperSpeed& of) const {
    return static_cast<double>(of.plate_impulses) * plate_impulse + static_cast<double>(of.rod_impulses) * rod_impulse;
  }
  /// Every impulse reads and writes the state of the rods that it changes, one or two [s].
  double memory_alone(const StepperSpeed& of) const {
    return static_cast<double>(of.plate_impulses + 2 * of.rod_impulses) * state_access;
  }
};

/// Runs the real kernels (sim/motion, sim/contact) on the rods of `world`. A plate impulse hits the end that comes
/// first; an impulse between rods hits the closest beads of two rods that approach each other, wherever they are.
LowerBounds measure_lower_bounds(const World& world);

/// Both steppers on one scene.
struct SceneSpeed {
  Contender scheduled, reference;
  Tick compared_ticks = 0;           ///< from the steady state to the end of the reference's stretch
  std::uint64_t scheduled_hash = 0;  ///< of the scheduled stepper's state then; must be that of the reference
  /// CPU time of the scheduled stepper's phases, from a run of their own, and the whole of that run [s].
  std::array<double, kPhases> phases{};
  double phases_cpu = 0;
  LowerBounds bounds{};
};

/// Both steppers in turn, each time from the same steady state; then the phases and the bounds.
SceneSpeed measure_scene(const Case& scene, const SteadyState& state, const Effort& effort);
Report speed_report(const Conditions& conditions, const std::vector<SceneSpeed>& scenes);

/// What the scheduled stepper does on one scene to know where to look.
struct CountedWork {
  Contender of;
  std::array<std::int64_t, kWorkKinds> counts{};
  std::array<double, kPhases> phases{};  ///< CPU time [s]
  double cpu = 0;                        ///< of the whole stretch [s]
  BoundsByKind bounds;
};

/// A stretch of the contender's ticks from where `settled` is; not the bounds.
CountedWork count_work(const Contender& of, Simulation& settled);
/// A run of the contender for its ticks, and the bounds at its end.
CountedWork measure_work(const Contender& of);
/// Adds the counts per rod-second, and the CPU time that each costs, to a row.
void add_work(Json& row, const CountedWork& counted);
/// Tables of these, whose lines begin with the columns `scene`.
std::string work_text(const Json& rows, const std::vector<Column>& scene);
Report count_report(const Conditions& conditions, const std::vector<CountedWork>& scenes);

/// A kind of scene whose speed is compared with that of others.
struct SceneKind {
  const char* name;
  const char* patch;  ///< JSON: what a user would write in place of some keys of the base (a merge patch, RFC 7396)
};

/// Every kind; the first is the base itself.
const std::vector<SceneKind>& scene_kinds();
Case case_of(const SceneKind& kind, double warm_up);
/// Times the kinds in turn, then counts what the scheduled stepper does on each.
std::vector<CountedWork> measure_kinds(std::vector<Contender> kinds, int repeat);
/// A row for each; their costs are relative to the first.
Report kinds_report(const Conditions& conditions, const std::vector<CountedWork>& measured);

/// The scheduled stepper's cost along a series of scenes that differ in their number of rods or in their step.
enum class Scaling { kRods, kStep };
Report scaling_report(const Conditions& conditions, Scaling of, const std::vector<Contender>& series);

/// The scheduled stepper by several numbers of threads, on one scene.
struct ThreadsSpeed {
  std::vector<Contender> by;
  double serial = 0;  ///< share of the CPU time of one thread that several cannot share

  /// The speed-up that so many threads cannot exceed if they share the rest evenly (Amdahl 1967).
  double limit(int n_threads) const { return 1 / (serial + (1 - serial) / n_threads); }
};

/// Of one thread's CPU time, the share that it spends where it alone has work. Of a run for as many ticks as the
/// contender's.
double measure_serial_share(const Contender& of);
Report threads_report(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes);

}  // namespace shaken::bench
