#include <fmt/format.h>

#include <algorithm>

#include "run/files/foreign_file.h"
#include "run/files/trajectory.h"
#include "run/import/imported_rods.h"
#include "scene/load.h"
#include "sim/start/from_another_run.h"
#include "sim/world.h"

namespace shaken::run {

Result<std::vector<ImportedRod>> read_recorded_rods(const std::string& file, std::optional<int> frame,
                                                    const System& system) {
  SHAKEN_TRY(try_to_read(file));
  const auto frames = SHAKEN_TRY(TrajectoryReader::open(file));
  const TrajectoryHeader& header = frames.header();
  auto plan = scene::load_scene(header.scene_json, file + ", its scene");
  if (!plan) return Error{keys::to_string(plan.error())};
  if (frames.n_frames() == 0) return Error{file + " has no frames"};
  const auto index = frame ? static_cast<std::size_t>(*frame) : frames.n_frames() - 1;
  const Snapshot snapshot = SHAKEN_TRY(frames.frame(index));
  const auto& added = plan->system.added;
  const bool has_one_species = std::ranges::none_of(added, [](const auto& species) { return species.has_value(); });
  if (has_one_species) plan->system.n_rods = static_cast<int>(snapshot.n_rods());  // of tracked ones some may be missed
  std::string differs = start_mismatch(system, plan->system);
  if (is_resized(system, plan->system)) {
    differs += fmt::format("{}the side of the box or the gap ({:.10g} mm and {:.10g} mm in the file)",
                           differs.empty() ? "" : ", ", plan->system.box_side, plan->system.gap);
  }
  if (system.n_rods != plan->system.n_rods) differs += fmt::format("; there, rods.count is {}", plan->system.n_rods);
  if (!differs.empty()) {
    return Error{
        fmt::format("{}: not the same in the scene: {}; a run that starts from the imported rods may then have "
                    "another box and gap",
                    file, differs)};
  }

  const World world = empty_world(plan->system);
  const bool has_plates = system.base || system.lid;
  const double base = world.plates.at(has_plates ? snapshot.tick : 0).base;
  std::vector<ImportedRod> rods;
  for (std::size_t i = 0; i < snapshot.n_rods(); ++i) {
    ImportedRod rod{.number = static_cast<int>(i),
                    .shape = world.shape_of_rod[i],
                    .position = snapshot.position[i],
                    .director = snapshot.director[i],
                    .velocity = snapshot.velocity[i]};
    rod.position.z() -= base;
    rods.push_back(rod);
  }
  return rods;
}

}  // namespace shaken::run
