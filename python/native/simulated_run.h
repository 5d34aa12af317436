#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "base/keys/problem.h"
#include "run/import/imported_rods.h"
#include "run/loop/open_run.h"
#include "run/loop/slice.h"
#include "scene/keys/run_plan.h"

namespace shaken::python {

/// A scene, and values of single keys that are set in it ("path=value"), in their order.
struct Scene {
  std::string text;
  std::vector<std::string> settings{};
};
/// All problems, in one.
Error as_error(const std::vector<keys::Problem>& problems);
/// What the scene resolves to; fails with all that is wrong with it.
Result<scene::RunPlan> resolved(const Scene& scene);

/// What a run has taken so far.
struct Spent {
  double cpu_seconds = 0, wall_seconds = 0;  ///< of steps
  std::string started;                       ///< UTC
};

/// What a run needs to go on elsewhere as if it had not stopped.
struct SavedRun {
  Scene scene;
  std::optional<scene::StartState> start;  ///< where the rods come from, if they were not placed by the scene
  double time_before = 0;                  ///< length of the stages before this one [s]
  Spent spent;
  std::vector<std::byte> simulation{}, measurements{};
};

/// A run in this process: its simulation, what its scene measures, and the stages that it goes through. Files are
/// neither read nor written, but for those of a run that the scene starts from.
class SimulatedRun {
 public:
  static Result<SimulatedRun> start(Scene scene, const GoOn& go_on);
  /// Begins with these rods in place of those that the scene places, as `shaken import` does. With `draws_velocities`
  /// they get those of any other start.
  static Result<SimulatedRun> start(Scene scene, const std::vector<run::ImportedRod>& rods, bool draws_velocities);
  static Result<SimulatedRun> resume(const SavedRun& saved);
  /// Fails after trouble, from which nothing goes on.
  Result<SavedRun> save() const;

  /// Steps towards `target` for as long as a slice; whether it is there. Trouble is final.
  bool advance(Tick target);
  const std::optional<NumericalTrouble>& trouble() const { return trouble_; }
  /// The first tick from now on at which the plates begin a vibration; now, where none comes soon.
  Tick next_beat() const;
  /// Fails with what is wrong with a scene in which `settings` hold.
  Result<void> may_set(const std::vector<std::string>& settings) const;
  /// Begins a stage in which `settings` hold, as a stage of a protocol does: at tick 0, with the rods as they are, and
  /// with measurements of its own. Fails if the plates are in the middle of a vibration, or if the rods do not fit.
  Result<void> begin_stage(const std::vector<std::string>& settings, const GoOn& go_on);

  const scene::RunPlan& plan() const { return plan_; }
  Simulation& simulation() { return run_.simulation; }
  const Simulation& simulation() const { return run_.simulation; }
  double time_before() const { return time_before_; }
  /// What the measurements of this stage say so far, and what summary.json would.
  run::Reduction reduce() const { return run_.measurements.reduce(run_.simulation.time()); }
  std::string summary(const run::Reduction& reduction) const;

 private:
  SimulatedRun(Scene scene, scene::RunPlan plan, Simulation simulation);
  void measure();

  Scene scene_;
  scene::RunPlan plan_;
  run::OpenRun run_;
  run::Slice slice_;
  double time_before_ = 0;
  Spent spent_;
  std::optional<NumericalTrouble> trouble_;
};

}  // namespace shaken::python
