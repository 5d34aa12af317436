#include "sim/neighbors/neighbor_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim/contact/bead_contacts.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

/// A list for rods of one species; no test here has more of them than this.
NeighborList list_of(const Species& rod, const Box& box, double skin) {
  static const std::vector<std::uint8_t> kinds(4096, 0);
  return {std::span(&rod, 1), kinds, box, skin};
}

bool holds(const NeighborList& list, int i, int j) {
  const auto own = list.pairs_of(i);
  return std::any_of(own.begin(), own.end(), [&](int p) { return list.pairs()[p].i == i && list.pairs()[p].j == j; });
}

/// Every pair of rods whose beads touch is listed. Returns how many there are.
int expect_complete(const NeighborList& list, const Species& rod, const std::vector<Pose>& poses, const Box& box) {
  int n_touching = 0;
  for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(poses.size()); ++j) {
      std::vector<BeadContact> contacts;
      find_bead_contacts(rod, poses[i].director, rod, poses[j].director,
                         nearest_image(poses[i].position, poses[j].position, box), contacts);
      if (contacts.empty()) continue;
      ++n_touching;
      EXPECT_TRUE(holds(list, i, j)) << i << ' ' << j;
    }
  }
  return n_touching;
}

/// Every other one a square.
Box random_box(test::Draw& draw, double least, double most) {
  const double side = draw.uniform(least, most);
  return draw.integer(0, 1) == 0 ? Box(side) : Box(side, draw.uniform(least, most));
}

std::vector<Pose> random_poses(test::Draw& draw, const Box& box, bool upright) {
  std::vector<Pose> poses(draw.integer(2, 60));
  for (Pose& pose : poses) {
    pose = {Vec3{draw.uniform(0, box.x()), draw.uniform(0, box.y()), draw.uniform(0.4, 0.8)},
            draw.flat_direction(upright ? 1.0 : 0.3)};
  }
  return poses;
}

/// A random walk of places, angles and tilts, across the border too.
void stir(test::Draw& draw, std::vector<Pose>& poses) {
  for (Pose& pose : poses) {
    pose.position += Vec3{draw.normal(), draw.normal(), 0} * 0.01;
    pose.director = (pose.director + draw.vector(0.005) + Vec3(0, 0, 0.02 * draw.normal())).normalized();
  }
}

TEST(NeighborList, HoldsEveryTouchingPairUntilItIsDue) {
  test::Draw draw(11);
  int n_touching = 0, n_not_due = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Box box = random_box(draw, 10, 40);
    const Species rod = make_species({.length = draw.uniform(2.5, 4.5), .n_beads = 9});
    NeighborList list = list_of(rod, box, 0.3);
    std::vector<Pose> poses = random_poses(draw, box, trial % 3 == 0);
    EXPECT_TRUE(list.is_due(poses));
    list.build(poses);
    EXPECT_FALSE(list.is_due(poses));
    EXPECT_TRUE(std::is_sorted(list.pairs().begin(), list.pairs().end(),
                               [](const auto& a, const auto& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); }));
    for (int move = 0; move < 20; ++move) {
      stir(draw, poses);
      if (list.is_due(poses)) break;
      ++n_not_due;
      n_touching += expect_complete(list, rod, poses, box);
    }
  }
  EXPECT_GT(n_touching, 500);
  EXPECT_GT(n_not_due, 100);
}

TEST(NeighborList, KeptUpRodByRodItStaysCompleteAndSaysWhatChanged) {
  test::Draw draw(13);
  int n_touching = 0, n_gained = 0, n_lost = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Box box = random_box(draw, 10, 40);
    const Species rod = make_species({.length = draw.uniform(2.5, 4.5), .n_beads = 9});
    NeighborList list = list_of(rod, box, 0.3);
    std::vector<Pose> poses = random_poses(draw, box, trial % 3 == 0);
    list.build(poses);
    std::set<int> listed;
    for (int p = 0; p < static_cast<int>(list.pairs().size()); ++p) listed.insert(p);
    for (int move = 0; move < 100; ++move) {
      stir(draw, poses);
      if (draw.integer(0, 9) == 0) poses[0].position += draw.vector(3);  // far enough to lose all its neighbours
      std::vector<int> due;
      for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
        if (list.slack(i, poses[i]) < 0) due.push_back(i);
      }
      for (const int i : due) list.place(i, poses[i]);
      for (const int i : due) {
        std::vector<int> near, gained, lost;
        list.find_near(i, near);
        list.replace_pairs(i, near, gained, lost);
        EXPECT_GT(list.slack(i, poses[i]), 0.14);
        for (const int p : lost) EXPECT_EQ(listed.erase(p), 1u);
        for (const int p : gained) {
          EXPECT_TRUE(listed.insert(p).second);
          EXPECT_TRUE(list.pairs()[p].i == i || list.pairs()[p].j == i);
        }
        n_gained += static_cast<int>(gained.size());
        n_lost += static_cast<int>(lost.size());
      }
      EXPECT_FALSE(list.is_due(poses));
      n_touching += expect_complete(list, rod, poses, box);
      for (int p = 0; p < static_cast<int>(list.pairs().size()); ++p) {
        const auto& [i, j] = list.pairs()[p];
        EXPECT_EQ(i >= 0, listed.contains(p));
        EXPECT_TRUE(i < 0 || holds(list, i, j));
      }
    }
  }
  EXPECT_GT(n_touching, 5000);
  EXPECT_GT(n_gained, 500);
  EXPECT_GT(n_lost, 500);
}

/// The slow twin of who is near whom: of every image within three boxes, the distance of the two flattened segments.
bool are_near(const Species& rod, const Pose& a, const Pose& b, const Box& box, double skin) {
  const auto flat = [](const Vec3& n) { return Vec3(n.x(), n.y(), 0).normalized(); };
  const double reach = 2 * rod.max_radius + skin;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      Vec3 D = b.position - a.position + Vec3(x * box.x(), y * box.y(), 0);
      D.z() = 0;
      if (segment_distance_squared(D, flat(a.director), rod.half_length, flat(b.director), rod.half_length) <=
          reach * reach)
        return true;
    }
  }
  return false;
}

std::vector<Species> small_and_large() {
  return {make_species({.length = 2.5, .n_beads = 9}), make_species({.length = 4.5, .n_beads = 15}),
          make_species({.length = 0.8, .n_beads = 1}),
          make_species({.length = 0.2, .mid_diameter = 0.2, .end_diameter = 0.2, .n_beads = 1}),
          make_species({.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}})};
}

TEST(NeighborList, HoldsPairsOfWhichAnyImagesAreNear) {
  test::Draw draw(15);
  int n_near = 0, n_far = 0;
  for (const Species& rod : small_and_large()) {
    const double least = least_box_side(std::span(&rod, 1));
    for (int trial = 0; trial < 80; ++trial) {
      const Box box = trial == 0 ? Box(least) : random_box(draw, least, 2.5 * least);
      NeighborList list = list_of(rod, box, 0.4);
      std::vector<Pose> poses = random_poses(draw, box, trial % 3 == 0);
      list.build(poses);
      for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
        for (int j = i + 1; j < static_cast<int>(poses.size()); ++j) {
          const bool near = are_near(rod, poses[i], poses[j], box, 0.4);
          ++(near ? n_near : n_far);
          ASSERT_EQ(holds(list, i, j), near)
              << "half-length " << rod.half_length << ", box " << box.x() << ' ' << box.y();
        }
      }
    }
  }
  EXPECT_GT(n_near, 40000);
  EXPECT_GT(n_far, 4000);
}

TEST(NeighborList, StaysCompleteInSmallBoxes) {
  test::Draw draw(16);
  int n_touching = 0;
  for (const Species& rod : small_and_large()) {
    const double least = least_box_side(std::span(&rod, 1));
    for (int trial = 0; trial < 100; ++trial) {
      const Box box = trial == 0 ? Box(least) : random_box(draw, least, 1.4 * least);
      NeighborList list = list_of(rod, box, 0.4);
      // few, and straight on their way: pairs that come near in another image than that in which they leave
      std::vector<Pose> poses(3);
      std::vector<Vec3> steps(3);
      for (int i = 0; i < 3; ++i) {
        poses[i] = {Vec3{draw.uniform(0, box.x()), draw.uniform(0, box.y()), 0.6}, draw.flat_direction(0.3)};
        steps[i] = draw.vector(0.02);
        steps[i].z() = 0;
      }
      list.build(poses);
      for (int move = 0; move < 400; ++move) {
        for (int i = 0; i < 3; ++i) {
          poses[i].position += steps[i];
          if (list.slack(i, poses[i]) >= 0) continue;
          list.place(i, poses[i]);
          std::vector<int> near, gained, lost;
          list.find_near(i, near);
          list.replace_pairs(i, near, gained, lost);
        }
        n_touching += expect_complete(list, rod, poses, box);
      }
    }
  }
  EXPECT_GT(n_touching, 5000);
}

TEST(NearestImage, RoundsAsTheLibraryDoes) {
  test::Draw draw(14);
  for (int trial = 0; trial < 100000; ++trial) {
    const double side = draw.uniform(5, 200);
    const double x = draw.integer(0, 3) ? draw.uniform(-1e4, 1e4) : 0.5 * side * draw.integer(-9, 9);
    const Vec3 d = nearest_image(Vec3(0, 0, 0), Vec3(x, -x, x), Box(side, 0.5 * side));
    EXPECT_EQ(d.x(), x - side * std::nearbyint(x / side));
    EXPECT_EQ(d.y(), -x - 0.5 * side * std::nearbyint(-x / (0.5 * side)));
    EXPECT_EQ(d.z(), x);
  }
}

TEST(NeighborList, TiltAloneNeverMakesItDue) {
  const Species rod = make_species({});
  NeighborList list = list_of(rod, 30, 0.3);
  std::vector<Pose> poses{{Vec3(5, 5, 0.6), Vec3::UnitX()}};
  list.build(poses);
  poses[0].director = Vec3(std::cos(0.3), 0, std::sin(0.3));
  poses[0].position.z() = 0.9;
  EXPECT_FALSE(list.is_due(poses));
  poses[0].position.x() += 0.16;
  EXPECT_TRUE(list.is_due(poses));
}

}  // namespace
}  // namespace shaken
