// SPDX-License-Identifier: MIT
#include "sim/close_up.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/simulation.h"

namespace shaken {
namespace {

Scene dense_scene() {
  Scene scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.box_side = 12;
  scene.n_rods = 80;
  scene.dt = 2e-5;
  return scene;
}

TEST(CloseUp, ShowsEveryRodAsTheSnapshotDoesAndEveryContactOnce) {
  auto simulation = Simulation::start(dense_scene());
  ASSERT_TRUE(static_cast<bool>(simulation));
  std::vector<int> everyone;
  for (int i = 0; i < 80; ++i) everyone.push_back(79 - i);
  int n_contacts = 0;
  for (Tick tick = 3000; tick < 3050; ++tick) {
    ASSERT_FALSE(simulation->advance_to(tick).has_value());
    const World& world = simulation->world();
    const Snapshot all = simulation->snapshot();
    const CloseUp seen = look_closely(world, tick, everyone);
    ASSERT_EQ(seen.rods.size(), 80U);
    for (int i = 0; i < 80; ++i) {
      EXPECT_EQ(seen.rods[i].rod, i);
      EXPECT_EQ(seen.rods[i].pose.director, all.director[i]);
      EXPECT_EQ(seen.rods[i].motion.velocity, all.velocity[i]);
      EXPECT_EQ(seen.rods[i].motion.angular_velocity, all.angular_velocity[i]);
    }
    std::map<std::pair<int, int>, int> contacts;
    for (const CloseUp::Contact& contact : seen.contacts) {
      if (contact.other >= 0) ++contacts[std::minmax(contact.rod, contact.other)];
    }
    std::vector<BeadContact> found;
    for (int i = 0; i < 80; ++i) {
      for (int j = i + 1; j < 80; ++j) {
        found.clear();
        find_bead_contacts(world.species[0], all.director[i], world.species[0], all.director[j],
                           nearest_image(all.position[i], all.position[j], world.scene.box_side), found);
        EXPECT_EQ((contacts[{i, j}]), static_cast<int>(found.size())) << i << " " << j;
        n_contacts += static_cast<int>(found.size());
      }
    }
  }
  EXPECT_GT(n_contacts, 10);
}

TEST(CloseUp, OfOneRodShowsItsNeighbours) {
  auto simulation = Simulation::start(dense_scene());
  ASSERT_FALSE(simulation->advance_to(100).has_value());
  const CloseUp seen = look_closely(simulation->world(), 100, {7});
  ASSERT_GT(seen.rods.size(), 3U);
  ASSERT_LT(seen.rods.size(), 20U);
  EXPECT_EQ(seen.rods[0].rod, 7);
  EXPECT_TRUE(seen.rods[0].concerned);
  for (std::size_t k = 1; k < seen.rods.size(); ++k) EXPECT_FALSE(seen.rods[k].concerned);
}

TEST(CloseUp, LeavesOutFlightsThatBeganLater) {
  auto simulation = Simulation::start(dense_scene());
  ASSERT_FALSE(simulation->advance_to(3000).has_value());
  int rod = 0;  // one that has been hit since tick 0
  while (simulation->world().rods[rod].since == 0) ++rod;
  const CloseUp seen = look_closely(simulation->world(), 0, {rod});
  EXPECT_EQ(seen.unknown, std::vector<int>{rod});
  EXPECT_TRUE(seen.rods.empty());
}

}  // namespace
}  // namespace shaken
