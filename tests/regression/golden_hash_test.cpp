// SPDX-License-Identifier: MIT
// One hash per scene, pinned: any change of the trajectory, down to the last bit, shows here. A change that is meant
// gets new hashes, a new physics version (sim/core/physics_version.h) and a line in CHANGELOG.md under "changes
// results".
#include <gtest/gtest.h>

#include "sim/simulation.h"

namespace shaken {
namespace {

struct Golden {
  const char* name;
  Scene scene;
  Tick ticks;
  std::uint64_t hash;
};

Scene scene_of(double length, double side, int n_rods) {
  Scene scene;
  scene.rod.length = length;
  scene.rod.n_beads = beads_for_pitch(length, scene.rod.end_diameter, 0.3);
  scene.box_side = side;
  scene.n_rods = n_rods;
  return scene;
}

/// A scene with so much of everything that little of the engine is left out.
Scene mixed(Arena arena) {
  Scene scene = scene_of(2.5, 14, 0);
  scene.added = {AddedRods{{.length = 3.0, .mid_diameter = 0.9, .n_beads = 11, .profile = Profile::kPolar}, 8},
                 AddedRods{{.length = 0.8, .n_beads = 1}, 8}};
  scene.walls = SideWalls{arena, 13.0, 3.0, {0.1, 0.3}};
  scene.n_rods = arena == Arena::kSquare ? 22 : 14;
  scene.start = Start::kRandom;
  return scene;
}

TEST(GoldenHash, TrajectoriesAreWhatTheyWere) {
  std::vector<Golden> cases{
      {"dense, l = 4.5 mm", scene_of(4.5, 20, 120), 5000, 0x6d37e6237c1429f8},
      {"dilute, l = 2.5 mm, random start", scene_of(2.5, 20, 80), 10000, 0x2be0513754d8d449},
      {"spheres", scene_of(0.8, 10, 100), 10000, 0x3e2867eebde8c3eb},
      {"no whole period", scene_of(3.5, 15, 70), 5000, 0x5dd37aa346510b5f},
      {"several kinds in a square, rough plates", mixed(Arena::kSquare), 30000, 0xf347b02339560ed8},
      {"several kinds in a disc, impacts at their instant", mixed(Arena::kDisc), 30000, 0x9dfdbc90a683d4f2},
      {"several kinds in an annulus, Poisson's law, shuffled", mixed(Arena::kAnnulus), 30000, 0x5fc6427c01ce1186},
      {"impacts at their instant, Stronge's law, sticky and rough", scene_of(4.5, 20, 110), 5000, 0xe3865ee0884cfd4c},
      {"beads one by one", scene_of(2.5, 14, 60), 5000, 0x562fb18d67bb49aa},
      {"the smallest box", scene_of(2.5, 5.5, 8), 40000, 0x397aa841b294fade},
  };
  cases[1].scene.start = Start::kRandom;
  cases[2].scene.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  cases[3].scene.frequency = 173.3;
  cases[4].scene.rotational_noise = 0.05;
  cases[5].scene.impacts = ImpactTime::kAtInstant;
  cases[6].scene.law = ImpulseLaw::kPoisson;
  cases[6].scene.order = ContactOrder::kShuffled;
  cases[7].scene.impacts = ImpactTime::kAtInstant;
  cases[7].scene.law = ImpulseLaw::kEnergetic;
  cases[7].scene.rod_rod.friction = cases[7].scene.rod_base.friction = 0.5;
  cases[7].scene.rotational_noise = 0.02;
  cases[8].scene.rod = {.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}};
  for (const Golden& golden : cases) {
    auto simulation = Simulation::start(golden.scene);
    ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
    const auto trouble = simulation->advance_to(golden.ticks);
    ASSERT_FALSE(trouble.has_value()) << trouble->what;
    const Counters& did = simulation->world().counters;
    EXPECT_GT(did.impulses_rod_rod, 20) << golden.name;
    if (golden.scene.walls) {
      EXPECT_GT(did.impulses_rod_wall, 10) << golden.name;
    }
    EXPECT_EQ(simulation->state_hash(), golden.hash) << golden.name << std::hex << ": 0x" << simulation->state_hash();
  }
}

}  // namespace
}  // namespace shaken
