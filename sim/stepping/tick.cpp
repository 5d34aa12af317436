// SPDX-License-Identifier: MIT
#include "sim/stepping/tick.h"

#include <algorithm>
#include <compare>

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
      impulse(impulse_function(world.scene.law)),
      impacts_at_instant(world.scene.has_impacts_at_instant()),
      has_base(world.scene.base),
      has_lid(world.scene.lid),
      walls(world.scene.walls),
      has_rotational_noise(world.scene.has_rotational_noise()),
      rotational_noise(world.scene.rotational_noise),
      seed(world.scene.seed),
      plates(world.plates) {
  for (const Species& species : world.species) kinds.emplace_back(species);
  max_speed2 = max_speed(world) * max_speed(world);
  if (plates.peak_acceleration() < gravity) rest = {0.5 * gravity * dt, kRiseRate};
}

void sort_contacts(std::vector<PairContact>& contacts, const std::vector<RodAtTick>& rods, const TickRules& rules) {
  const auto place = [&](int i, int bead) -> Vec3 {
    return rules.kind_of(i).species.bead_offset[bead] * rods[i].pose.director;
  };
  const auto compare = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(contacts.begin(), contacts.end(), [&](const PairContact& a, const PairContact& b) {
    if (a.i != b.i) return a.i < b.i;
    if (a.j != b.j) return a.j < b.j;
    if (a.beads.overlap != b.beads.overlap) return a.beads.overlap > b.beads.overlap;
    const auto of_i = compare(place(a.i, a.beads.bead_i), place(b.i, b.beads.bead_i));
    if (std::is_neq(of_i)) return std::is_lt(of_i);
    return std::is_lt(compare(place(a.j, a.beads.bead_j), place(b.j, b.beads.bead_j)));
  });
}

}  // namespace shaken
