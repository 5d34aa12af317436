// SPDX-License-Identifier: MIT
#include "run/saved_run.h"

#include <optional>
#include <utility>

#include "base/files.h"
#include "run/checkpoint_file.h"
#include "scene/load.h"

namespace shaken::run {

Result<scene::RunPlan> read_plan(const RunDirectory& directory) {
  const Result<std::string> text = read_file(directory.scene());
  if (!text) return text.error();
  const scene::Loaded<scene::RunPlan> plan = scene::load_scene(*text, directory.scene().string());
  if (!plan.value) return Error{to_string(plan.problems)};
  return *plan.value;
}

Result<Simulation> resume_last(const RunDirectory& directory, const std::string& run_id, const System& system,
                               Tick before) {
  std::optional<Error> trouble;  // with the newest
  const auto fails = [&](const std::string& message) {
    if (!trouble) trouble = Error{message};
  };
  for (const auto& file : directory.checkpoints()) {
    const Result<Checkpoint> checkpoint = read_checkpoint(file, run_id);
    if (!checkpoint) {
      fails(checkpoint.error().message);
      continue;
    }
    Result<Simulation> simulation = Simulation::resume(system, checkpoint->simulation);
    if (simulation && simulation->tick() < before) return simulation;
    fails(file.string() + ": " + (simulation ? "too late a state" : simulation.error().message));
  }
  return *trouble;
}

}  // namespace shaken::run
