#include "client/scene_input.h"

#include <fmt/format.h>

#include <cmath>

#include "base/failure.h"
#include "base/files.h"
#include "base/text.h"
#include "scene/canonical.h"
#include "scene/keys/derived.h"
#include "scene/keys/observables.h"
#include "scene/placement.h"
#include "scene/remarks.h"

namespace shaken::client {

SceneInput read_scene_input(const std::string& file) {
  if (file == "-") {
    return {"stdin", value_or_fail(read_standard_input(), ExitCode::kBadInput)};
  }
  return {file, value_or_fail(read_input(file), ExitCode::kBadInput)};
}

std::string refusal_text(const std::vector<keys::Problem>& problems) {
  return fmt::format("refused, with {}\n{}", counted(problems.size(), "problem"), keys::to_string(problems));
}

scene::Sweep load_points(const SceneInput& input, const std::vector<std::string>& settings,
                         std::optional<int> replicas) {
  auto loaded = scene::load_runs(input.text, input.file, settings, replicas);
  if (!loaded) throw Failure(ExitCode::kBadInput, refusal_text(loaded.error()));
  return std::move(loaded).value();
}

Json derived_quantities(const scene::SweepPoint& point) {
  const scene::RunPlan& plan = point.plan;
  const System& system = plan.system;
  Json species = Json::array();
  const auto add_species = [&](const std::string& name, const RodShape& rod, int count) {
    species.push_back(
        {{"name", name}, {"count", count}, {"area_fraction", scene::area_fraction_of(system, rod, count)}});
  };
  add_species("rods", system.rod, system.n_rods);
  for (std::size_t k = 0; k < system.added.size(); ++k) {
    if (const auto& added = system.added[k]) add_species(fmt::format("rods_{}", k + 2), added->rod, added->count);
  }
  Json json{{"id", scene::run_id(plan)},
            {"n_rods", system.n_all_rods()},
            {"area_fraction", scene::total_area_fraction_of(system)},
            {"species", species},
            {"gamma", nullptr},  // where there is no gravity
            {"amplitude_mm", system.amplitude},
            {"sim_seconds", plan.total_time()},
            {"ticks", std::llround(plan.total_time() / system.dt)},
            {"trajectory_frames", 0},
            {"measurement_memory_bytes", scene::peak_of(scene::measure_memory(plan))},
            {"remarks", scene::remarks(plan)}};
  if (const auto gamma = scene::gamma_of(system)) json["gamma"] = *gamma;
  if (const auto every = plan.recording_every())
    json["trajectory_frames"] = std::llround(plan.total_time() / *every) + 1;
  return json;
}

}  // namespace shaken::client
