#include "scene/keys/measured_species.h"

#include <fmt/format.h>

namespace shaken::scene {

std::vector<MeasuredRods> measured_species(const RunPlan& plan) {
  std::vector<MeasuredRods> found{{0, "", plan}};
  found.front().plan.system.added = {};
  if (plan.of == MeasuredSpecies::kFirst) return found;
  for (std::size_t k = 0; k < plan.system.added.size(); ++k) {
    if (const auto& added = plan.system.added[k]) {
      MeasuredRods rods{found.size(), fmt::format("rods_{}", k + 2), found.front().plan};
      rods.plan.system.rod = added->rod;
      rods.plan.system.n_rods = added->count;
      rods.plan.collisions.reset();  // of all rods, whatever their species
      rods.plan.stress.reset();
      rods.plan.mixing.reset();
      found.push_back(std::move(rods));
    }
  }
  return found;
}

RunPlan rods_of_species(const RunPlan& plan, std::size_t number) {
  const System& from = plan.system;
  RunPlan alone;
  System& system = alone.system = from;
  if (number > 0) {
    system.rod = from.added[number - 1]->rod;
    system.n_rods = from.added[number - 1]->count;
  }
  system.rod.spread = {};
  system.added = {};
  system.rod_rod = from.rod_rod.of(number, number);
  system.rod_base = from.rod_base.of(number);
  system.rod_lid = from.rod_lid.of(number);
  system.rotational_noise = from.noise_of(number);
  system.added_noise = {};
  system.walls.reset();
  system.posts.reset();
  system.box_aspect = 1;
  system.start = Start::kRandom;
  return alone;
}

}  // namespace shaken::scene
