// SPDX-License-Identifier: MIT
#include "sim/neighbors/neighbor_list.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/contact/bead_contacts.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

TEST(NeighborList, HoldsEveryTouchingPairUntilItIsDue) {
  test::Draw draw(11);
  int n_touching = 0, n_not_due = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double side = draw.uniform(10, 40);
    const Species rod = make_species({.length = draw.uniform(2.5, 4.5), .n_beads = 9});
    NeighborList list(rod, side, 0.3);
    std::vector<Pose> poses(draw.integer(2, 60));
    for (Pose& pose : poses) {
      pose = {Vec3(draw.uniform(0, side), draw.uniform(0, side), draw.uniform(0.4, 0.8)),
              draw.flat_direction(trial % 3 == 0 ? 1.0 : 0.3)};
    }
    EXPECT_TRUE(list.is_due(poses));
    list.build(poses);
    EXPECT_FALSE(list.is_due(poses));
    EXPECT_TRUE(std::is_sorted(list.pairs().begin(), list.pairs().end()));
    for (int move = 0; move < 20; ++move) {
      // a random walk of places, angles and tilts, across the border too, until the list says that it is due
      for (Pose& pose : poses) {
        pose.position += Vec3(draw.normal(), draw.normal(), 0) * 0.01;
        pose.director = (pose.director + draw.vector(0.005) + Vec3(0, 0, 0.02 * draw.normal())).normalized();
      }
      if (list.is_due(poses)) break;
      ++n_not_due;
      for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
        for (int j = i + 1; j < static_cast<int>(poses.size()); ++j) {
          std::vector<BeadContact> contacts;
          find_bead_contacts(rod, poses[i].director, rod, poses[j].director,
                             nearest_image(poses[i].position, poses[j].position, side), contacts);
          if (contacts.empty()) continue;
          ++n_touching;
          EXPECT_TRUE(std::binary_search(list.pairs().begin(), list.pairs().end(), std::pair(i, j)));
        }
      }
    }
  }
  EXPECT_GT(n_touching, 500);
  EXPECT_GT(n_not_due, 100);
}

TEST(NeighborList, CellsGiveTheSameAsAllPairs) {
  // the same rods in a box small enough for all pairs and, without periodic partners, in one with many cells
  test::Draw draw(12);
  const Species rod = make_species({.length = 2.5, .n_beads = 9});
  std::vector<Pose> poses(40);
  for (Pose& pose : poses) pose = {Vec3(draw.uniform(20, 26), draw.uniform(20, 26), 0.6), draw.flat_direction(0.3)};
  NeighborList many_cells(rod, 60, 0.3), few_cells(rod, 8, 0.3);
  many_cells.build(poses);
  few_cells.build(poses);
  for (const auto& pair : many_cells.pairs()) {
    EXPECT_TRUE(std::binary_search(few_cells.pairs().begin(), few_cells.pairs().end(), pair));
  }
  EXPECT_GT(many_cells.pairs().size(), 40u);
  EXPECT_EQ(std::adjacent_find(many_cells.pairs().begin(), many_cells.pairs().end()), many_cells.pairs().end());
}

TEST(NeighborList, TiltAloneNeverMakesItDue) {
  const Species rod = make_species({});
  NeighborList list(rod, 30, 0.3);
  std::vector<Pose> poses{{Vec3(5, 5, 0.6), Vec3::UnitX()}};
  list.build(poses);
  poses[0].director = Vec3(std::cos(0.3), 0, std::sin(0.3));
  poses[0].position.z() = 0.9;
  EXPECT_FALSE(list.is_due(poses));
  poses[0].position.x() += 0.16;
  EXPECT_TRUE(list.is_due(poses));
}

TEST(NearestImage, IsTheShortestAcrossTheBorder) {
  EXPECT_LT((nearest_image(Vec3(0.5, 9.5, 0), Vec3(9.5, 0.5, 1), 10) - Vec3(-1, 1, 1)).norm(), 1e-14);
}

}  // namespace
}  // namespace shaken
