#include "python/native/simulated_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clock.h"
#include "base/text.h"
#include "run/import/place_rods.h"
#include "run/loop/import_id.h"
#include "run/loop/start_state.h"
#include "run/loop/summary_of_run.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "sim/start/from_another_run.h"

namespace shaken::python {
namespace {

constexpr Tick kMostTicksToABeat = 1'000'000;

Scene with(Scene scene, const std::vector<std::string>& settings) {
  scene.settings.insert(scene.settings.end(), settings.begin(), settings.end());
  return scene;
}

}  // namespace

Error as_error(const std::vector<keys::Problem>& problems) {
  std::string all = to_string(problems);
  if (all.ends_with('\n')) all.pop_back();
  return Error{all};
}

Result<scene::RunPlan> resolved(const Scene& scene) {
  auto plan = scene::load_scene(scene.text, "scene", scene.settings);
  if (!plan) return as_error(plan.error());
  return std::move(plan).value();
}

SimulatedRun::SimulatedRun(Scene scene, scene::RunPlan plan, Simulation simulation)
    : scene_(std::move(scene)),
      plan_(std::move(plan)),
      run_(run::begin_run(plan_, std::move(simulation))),
      spent_{0, 0, utc_now()} {
  run_.recording.reset();
}

Result<SimulatedRun> SimulatedRun::start(Scene scene, const GoOn& go_on) {
  scene::RunPlan plan = SHAKEN_TRY(resolved(scene));
  Simulation simulation = SHAKEN_TRY(run::start_simulation(plan, {}, go_on));
  SimulatedRun run(std::move(scene), std::move(plan), std::move(simulation));
  run.measure();
  return run;
}

Result<SimulatedRun> SimulatedRun::start(Scene scene, const std::vector<run::ImportedRod>& rods,
                                         bool draws_velocities) {
  scene::RunPlan plan = SHAKEN_TRY(resolved(scene));
  for (const run::ImportedRod& rod : rods) {
    if (!plan.system.has_species(rod.shape))
      return Error{fmt::format("rod {} is of species {}, which the scene does not have", rod.number, rod.shape)};
  }
  const World empty = empty_world(plan.system);
  if (empty.species.size() != empty.species_of_shape.back() + 1U) {
    return Error{
        "rods of the scene differ in size, of which arrays say nothing: leave out length_spread and "
        "end_diameter_spread"};
  }
  std::vector<keys::Problem> problems;
  const scene::RunPlan placed = run::without_start(plan);
  auto found = run::place_rods(placed.system, rods, "the rods", false, problems);
  if (!found) return as_error(keys::tidied(std::move(problems)));
  if (draws_velocities) run::draw_velocities(found->world);
  const Simulation imported = Simulation::start_from(std::move(found->world));
  plan.start = scene::StartState{run::import_id(placed, imported), 0};
  Simulation simulation = SHAKEN_TRY(Simulation::start(plan.system, imported.world()));
  SimulatedRun run(std::move(scene), std::move(plan), std::move(simulation));
  run.measure();
  return run;
}

Result<SimulatedRun> SimulatedRun::resume(const SavedRun& saved) {
  scene::RunPlan plan = SHAKEN_TRY(resolved(saved.scene));
  plan.start = saved.start;
  Simulation simulation = SHAKEN_TRY(Simulation::resume(plan.system, saved.simulation));
  SimulatedRun run(saved.scene, std::move(plan), std::move(simulation));
  SHAKEN_TRY(run.run_.measurements.restore(saved.measurements));
  run.time_before_ = saved.time_before;
  run.spent_ = saved.spent;
  return run;
}

Result<SavedRun> SimulatedRun::save() const {
  if (trouble_) return Error{"it has met numerical trouble, from which nothing goes on: " + trouble_->what};
  return SavedRun{scene_, plan_.start, time_before_, spent_, run_.simulation.checkpoint(), run_.measurements.save()};
}

void SimulatedRun::measure() {
  if (run_.measurements.next_due(run_.simulation.tick()) == run_.simulation.tick())
    run_.measure(plan_, run_.simulation.snapshot());
}

bool SimulatedRun::advance(Tick target) {
  const double cpu_before = cpu_seconds();
  const auto begin = run::WallClock::now();
  while (!trouble_ && run_.simulation.tick() < target) {
    const Tick first = run_.simulation.tick();
    const auto before = run::WallClock::now();
    trouble_ = run_.simulation.advance_to(std::min({target, run_.next_due(first + 1), slice_.end(first)}));
    const auto now = run::WallClock::now();
    slice_.note(run_.simulation.tick() - first, now - before);
    if (!trouble_) measure();
    if (now - begin > run::kLongSlice) break;
  }
  spent_.cpu_seconds += cpu_seconds() - cpu_before;
  spent_.wall_seconds += run::WallSeconds(run::WallClock::now() - begin).count();
  return run_.simulation.tick() >= target;
}

Tick SimulatedRun::next_beat() const {
  const System& system = plan_.system;
  const Tick now = run_.simulation.tick();
  for (Tick tick = now; tick < now + kMostTicksToABeat; ++tick) {
    if (std::abs(off_the_beat(system, tick)) <= system.dt / 2) return tick;
  }
  return now;  // two vibrations that hardly ever begin together: the stage is refused
}

Result<void> SimulatedRun::may_set(const std::vector<std::string>& settings) const {
  const Result<scene::RunPlan> plan = resolved(with(scene_, settings));
  return plan ? Result<void>() : plan.error();
}

Result<void> SimulatedRun::begin_stage(const std::vector<std::string>& settings, const GoOn& go_on) {
  Scene next = with(scene_, settings);
  scene::RunPlan plan = SHAKEN_TRY(resolved(next));
  Simulation simulation = SHAKEN_TRY(Simulation::start(plan.system, run_.simulation.world(), go_on));
  plan.start = scene::StartState{scene::run_id(plan_), run_.simulation.time()};
  SimulatedRun stage(std::move(next), std::move(plan), std::move(simulation));
  stage.time_before_ = time_before_ + run_.simulation.time();
  stage.measure();
  *this = std::move(stage);
  return {};
}

std::string SimulatedRun::summary(const run::Reduction& reduction) const {
  run::Summary summary = run::summary_of(plan_, run_, reduction, std::nullopt);
  summary.cpu_seconds = spent_.cpu_seconds;
  summary.wall_seconds = spent_.wall_seconds;
  summary.started = spent_.started;
  if (trouble_) {
    summary.state = "failed";
    summary.reason = trouble_->what;
    summary.rods = trouble_->rods;
  } else if (run_.simulation.time() < plan_.total_time() - plan_.system.dt / 2) {
    summary.state = "stopped";
    summary.reason = "it has not been simulated any longer";
  }
  return run::summary_text(summary);
}

}  // namespace shaken::python
