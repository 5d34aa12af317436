// SPDX-License-Identifier: MIT
// One hash per scene, pinned: any change of the trajectory, down to the last bit, shows here. A change that is meant
// gets new hashes and a line in CHANGELOG.md under "changes results".
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

TEST(GoldenHash, TrajectoriesAreWhatTheyWere) {
  std::vector<Golden> cases{
      {"dense, l = 4.5 mm", scene_of(4.5, 20, 120), 5000, 0xef2b04a552f22c2d},
      {"dilute, l = 2.5 mm, random start", scene_of(2.5, 20, 80), 10000, 0xc5068f8882d85e87},
      {"spheres", scene_of(0.8, 10, 100), 10000, 0xe37ac10f2c044887},
      {"no whole period", scene_of(3.5, 15, 70), 5000, 0xd06e47f2f69dbdf2},
  };
  cases[1].scene.start = Start::kRandom;
  cases[2].scene.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  cases[3].scene.frequency = 173.3;
  for (const Golden& golden : cases) {
    auto simulation = Simulation::start(golden.scene);
    ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
    const auto trouble = simulation->advance_to(golden.ticks);
    ASSERT_FALSE(trouble.has_value()) << trouble->what;
    EXPECT_EQ(simulation->state_hash(), golden.hash) << golden.name << std::hex << ": 0x" << simulation->state_hash();
  }
}

}  // namespace
}  // namespace shaken
