#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "sim/close_up.h"
#include "sim/contact/bead_contacts.h"
#include "sim/overlaps.h"
#include "tests/support/random_rods.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

/// Twin: every bead of one against every bead of the other.
std::set<std::pair<int, int>> all_overlaps(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j,
                                           const Vec3& D) {
  std::set<std::pair<int, int>> found;
  for (int a = 0; a < i.n_beads(); ++a) {
    for (int b = 0; b < j.n_beads(); ++b) {
      const Vec3 r = (D - i.bead_offset[a] * n_i) + j.bead_offset[b] * n_j;
      const double touch = i.bead_radius[a] + j.bead_radius[b];
      if (r.squaredNorm() < touch * touch) found.insert({a, b});
    }
  }
  return found;
}

void expect_same(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j, const Vec3& D, int& n_touching) {
  std::vector<BeadContact> contacts;
  find_bead_contacts(i, n_i, j, n_j, D, contacts);
  std::set<std::pair<int, int>> found;
  std::pair<int, int> previous{-1, -1};
  for (const BeadContact& c : contacts) {
    const std::pair<int, int> beads{c.bead_i, c.bead_j};
    EXPECT_LT(previous, beads) << "not in ascending order";
    previous = beads;
    found.insert(beads);
    EXPECT_NEAR(c.normal.norm(), 1, 1e-14);
    const Vec3 r = (D - i.bead_offset[c.bead_i] * n_i) + j.bead_offset[c.bead_j] * n_j;
    EXPECT_NEAR(c.overlap, i.bead_radius[c.bead_i] + j.bead_radius[c.bead_j] - r.norm(), 1e-14);
    if (r.norm() > 1e-9) {
      EXPECT_GT(r.normalized().dot(c.normal), 1 - 1e-12);
    }
  }
  EXPECT_EQ(found, all_overlaps(i, n_i, j, n_j, D));
  n_touching += !found.empty();
}

TEST(BeadContacts, MatchBruteForceForRandomRods) {
  test::Draw draw(8);
  int n_touching = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Species i = make_species(
        {.length = draw.uniform(2, 5), .end_diameter = draw.uniform(0.2, 1.0), .n_beads = 2 * draw.integer(0, 8) + 1});
    const Species j = make_species({.length = draw.uniform(2, 5), .n_beads = 2 * draw.integer(0, 8) + 1});
    const bool flat = draw.integer(0, 1) == 1;
    const Vec3 n_i = flat ? draw.flat_direction(0.3) : draw.direction();
    const Vec3 n_j = flat ? draw.flat_direction(0.3) : draw.direction();
    expect_same(i, n_i, j, n_j, draw.direction() * draw.uniform(0, 5), n_touching);
  }
  EXPECT_GT(n_touching, 2000);
}

TEST(BeadContacts, MatchBruteForceForNearlyParallelRods) {
  test::Draw draw(9);
  const Species rod = make_species({});
  int n_touching = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 n_i = draw.direction();
    const double angle = std::pow(10.0, draw.uniform(-16, -1));
    const Vec3 n_j = ((draw.integer(0, 1) ? 1.0 : -1.0) * n_i + angle * draw.direction()).normalized();
    const Vec3 side = n_i.cross(draw.direction()).normalized();
    expect_same(rod, n_i, rod, n_j, draw.uniform(-4.5, 4.5) * n_i + draw.uniform(0.4, 0.85) * side, n_touching);
  }
  EXPECT_GT(n_touching, 2000);
}

TEST(BeadContacts, CoincidentCentresGetAVerticalNormal) {
  const Species rod = make_species({});
  std::vector<BeadContact> contacts;
  find_bead_contacts(rod, Vec3::UnitX(), rod, Vec3::UnitY(), Vec3::Zero(), contacts);
  bool met = false;
  for (const BeadContact& c : contacts) {
    EXPECT_TRUE(c.normal.allFinite());
    if (c.bead_i == 7 && c.bead_j == 7) {
      met = true;
      EXPECT_EQ(c.normal, Vec3(Vec3::UnitZ()));
      EXPECT_DOUBLE_EQ(c.overlap, 0.8);
    }
  }
  EXPECT_TRUE(met);
}

TEST(BeadContacts, SegmentDistanceMatchesASearch) {
  test::Draw draw(10);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 n_i = draw.direction();
    const Vec3 n_j = trial % 4 == 0 ? Vec3(n_i) : draw.direction();
    const Vec3 D = draw.vector(2);
    const double h_i = draw.uniform(0, 2), h_j = draw.uniform(0, 2);
    // convex in (s, t): alternate exact minimisation from several starts converges to the minimum
    double best = 1e9;
    for (int start = 0; start < 5; ++start) {
      double s = draw.uniform(-h_i, h_i), t = 0;
      for (int k = 0; k < 3000; ++k) {
        t = std::clamp(n_i.dot(n_j) * s - D.dot(n_j), -h_j, h_j);
        s = std::clamp(D.dot(n_i) + n_i.dot(n_j) * t, -h_i, h_i);
      }
      best = std::min(best, (D + t * n_j - s * n_i).squaredNorm());
    }
    EXPECT_NEAR(segment_distance_squared(D, n_i, h_i, n_j, h_j), best, 1e-6 * (1 + best));
  }
}

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
