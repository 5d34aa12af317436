// SPDX-License-Identifier: MIT
#include "sim/stepping/tick.h"

#include <algorithm>

#include "sim/initial.h"

namespace shaken {

double max_speed(const World& world) {
  const Scene& scene = world.scene;
  const double usual = world.plates.peak_speed() + std::sqrt(2.0 * scene.gravity * scene.gap) + kStartSpeed;
  double thinnest = scene.gap;
  for (const Species& species : world.species) {
    for (const double radius : species.bead_radius) thinnest = std::min(thinnest, radius);
  }
  return std::min(kMaxSpeedFactor * usual, thinnest / scene.dt);
}

TickRules::TickRules(const World& world)
    : rod_kinds(world.kinds),
      gravity(world.scene.gravity),
      dt(world.scene.dt),
      box_side(world.scene.box_side),
      rod_rod(world.scene.rod_rod),
      rod_base(world.scene.rod_base),
      rod_lid(world.scene.rod_lid),
      has_base(world.scene.base),
      has_lid(world.scene.lid),
      walls(world.scene.walls),
      rotational_noise(world.scene.rotational_noise),
      seed(world.scene.seed),
      plates(world.plates) {
  for (const Species& species : world.species) kinds.emplace_back(species);
  max_speed2 = max_speed(world) * max_speed(world);
  if (plates.peak_acceleration() < gravity) rest = {0.5 * gravity * dt, kRiseRate};
}

}  // namespace shaken
