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

}  // namespace shaken::scene
