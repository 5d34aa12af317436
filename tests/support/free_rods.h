// Starts of rods, and whether they are free.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/world.h"

namespace shaken::test {

/// So many rods of the paper's shape that they take this fraction of a square box.
inline System scene_at(double length, double area_fraction, double side, Start start, std::uint64_t seed = 1) {
  System system;
  system.rod.length = length;
  system.rod.n_beads = beads_for_pitch(length, system.rod.end_diameter, 0.3);
  system.box_side = side;
  system.start = start;
  system.seed = seed;
  system.n_rods = static_cast<int>(std::round(area_fraction * side * side / make_species(system.rod).area));
  return system;
}

/// Every pair, no neighbour list: nothing touches, nothing sticks into a plate.
inline void expect_free(const World& world) {
  std::vector<BeadContact> contacts;
  const System& system = world.system;
  ASSERT_EQ(static_cast<int>(world.rods.size()), system.n_all_rods());
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    const Flight& rod = world.rods[i];
    const Species& species = world.species_of(i);
    EXPECT_NEAR(rod.director.norm(), 1, 1e-12);
    for (int b = 0; b < species.n_beads(); ++b) {
      const double z = rod.position.z() + species.bead_offset[b] * rod.director.z();
      EXPECT_GT(z - species.bead_radius[b], 2 * system.amplitude);
      EXPECT_LT(z + species.bead_radius[b], 2 * system.amplitude + system.gap);
    }
    for (std::size_t j = i + 1; j < world.rods.size(); ++j) {
      find_bead_contacts(species, rod.director, world.species_of(j), world.rods[j].director,
                         nearest_image(rod.position, world.rods[j].position, system.box()), contacts);
    }
  }
  EXPECT_TRUE(contacts.empty()) << contacts.size() << " overlaps";
}

}  // namespace shaken::test
