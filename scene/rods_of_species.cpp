#include "scene/rods_of_species.h"

namespace shaken::scene {

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
