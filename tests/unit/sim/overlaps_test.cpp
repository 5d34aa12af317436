#include "sim/overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "sim/close_up.h"
#include "tests/support/random_rods.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

using Depths = std::map<std::pair<int, int>, double>;

Depths depths_of(const std::vector<Overlap>& overlaps) {
  Depths depths;
  for (const Overlap& overlap : overlaps) depths[{overlap.rod, overlap.other}] = overlap.depth;
  EXPECT_EQ(depths.size(), overlaps.size()) << "each once";
  return depths;
}

/// The same by looking at every bead of every two rods.
Depths slow_depths(const World& world) {
  std::vector<int> everyone(world.rods.size());
  std::iota(everyone.begin(), everyone.end(), 0);
  Depths depths;
  for (const CloseUp::Contact& contact : look_closely(world, 0, everyone).contacts) {
    const auto [rod, other] = contact.other < 0 ? std::pair(contact.rod, contact.other)
                                                : std::pair(std::minmax({contact.rod, contact.other}));
    double& depth = depths[{rod, other}];
    depth = std::max(depth, contact.overlap);
  }
  return depths;
}

/// Rods anywhere in the box and between the plates, so that many overlap.
World world_of_random_rods(const System& system, std::uint64_t seed) {
  World world = empty_world(system);
  test::Draw draw(seed);
  for (int i = 0; i < system.n_all_rods(); ++i) {
    Flight flight;
    flight.position = {draw.uniform(0, system.box().x()), draw.uniform(0, system.box().y()),
                       world.plates.at(0).base + draw.uniform(0.1, system.gap - 0.1)};
    flight.director = draw.flat_direction(0.3);
    flight.prepare();
    world.rods.push_back(flight);
  }
  return world;
}

std::vector<Overlap> overlaps_of(const World& world) {
  std::vector<Pose> poses;
  for (const Flight& flight : world.rods) poses.push_back({flight.position, flight.director});
  return find_overlaps(world, world.shape_of_rod, poses);
}

TEST(Overlaps, AreThoseOfALookAtAllBeads) {
  System mixed = test::short_rods(60);
  mixed.added[0] = AddedRods{.rod = {.length = 1.5, .n_beads = 5}, .count = 30};
  System walled = test::short_rods(40, 14);
  walled.walls = SideWalls{.arena = Arena::kDisc, .size = 11};
  System posts = test::short_rods(40);
  posts.posts = Posts{.diameter = 1.5, .columns = 2, .rows = 3};
  posts.lid = false;
  int kinds[5] = {};
  for (const System& system : {mixed, walled, posts}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const World world = world_of_random_rods(system, seed);
      const std::vector<Overlap> overlaps = overlaps_of(world);
      const Depths fast = depths_of(overlaps), slow = slow_depths(world);
      ASSERT_EQ(fast.size(), slow.size());
      for (const auto& [pair, depth] : slow) {
        ASSERT_TRUE(fast.contains(pair)) << pair.first << " " << pair.second;
        EXPECT_NEAR(fast.at(pair), depth, 1e-12) << pair.first << " " << pair.second;
        ++kinds[std::max(pair.second, -1) == -1 ? -pair.second : 0];
      }
      EXPECT_TRUE(std::is_sorted(overlaps.begin(), overlaps.end(),
                                 [](const Overlap& a, const Overlap& b) { return a.rod < b.rod; }));
    }
  }
  for (const int n : kinds) EXPECT_GT(n, 5) << "rods, base, lid, walls and posts";
}

TEST(Overlaps, OfTwoSpheresAndTheBaseAreKnown) {
  System system;
  system.rod = {.length = 1, .mid_diameter = 1, .end_diameter = 1, .n_beads = 1};
  system.n_rods = 2;
  system.box_side = 10;
  system.gap = 2;
  World world = empty_world(system);
  const double base = world.plates.at(0).base;
  const auto of = [&](const Vec3& one, const Vec3& other) {
    const std::vector<Pose> poses{{one, Vec3::UnitX()}, {other, Vec3::UnitX()}};
    return find_overlaps(world, world.shape_of_rod, poses);
  };
  EXPECT_TRUE(of({1, 1, base + 0.5}, {2.001, 1, base + 0.5}).empty());
  // across the border of the box
  const auto through = of({0.2, 1, base + 0.6}, {9.6, 1, base + 0.6});
  ASSERT_EQ(through.size(), 1U);
  EXPECT_EQ(through[0].rod, 0);
  EXPECT_EQ(through[0].other, 1);
  EXPECT_NEAR(through[0].depth, 0.4, 1e-12);
  const auto in_base = of({1, 1, base + 0.6}, {5, 1, base + 0.3});
  ASSERT_EQ(in_base.size(), 1U);
  EXPECT_EQ(in_base[0].rod, 1);
  EXPECT_EQ(in_base[0].other, CloseUp::kBase);
  EXPECT_NEAR(in_base[0].depth, 0.2, 1e-12);
  EXPECT_TRUE(find_overlaps(world, {}, {}).empty());
}

}  // namespace
}  // namespace shaken
