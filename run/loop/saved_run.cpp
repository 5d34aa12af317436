#include "run/loop/saved_run.h"

#include <utility>

#include "base/files.h"
#include "run/files/checkpoint_file.h"
#include "scene/load.h"

namespace shaken::run {

Result<scene::RunPlan> read_plan(const RunDirectory& directory) {
  const keys::Loaded<scene::RunPlan> plan =
      scene::load_scene(SHAKEN_TRY(read_file(directory.scene())), directory.scene().string());
  if (!plan) return Error{to_string(plan.error())};
  return *plan;
}

Result<Simulation> resume_last(const RunDirectory& directory, const std::string& run_id, const System& system,
                               Tick before) {
  const auto resume = [&](const std::filesystem::path& file) -> Result<Simulation> {
    Result<Simulation> simulation = Simulation::resume(system, SHAKEN_TRY(read_checkpoint(file, run_id)).simulation);
    if (simulation && simulation->tick() < before) return simulation;
    return Error{file.string() + ": " + (simulation ? "too late a state" : simulation.error().message)};
  };
  Result<Simulation> newest = resume(directory.checkpoint());
  if (newest) return newest;
  Result<Simulation> previous = resume(directory.previous_checkpoint());
  return previous ? std::move(previous) : std::move(newest);  // if neither will do, why the newest will not
}

}  // namespace shaken::run
