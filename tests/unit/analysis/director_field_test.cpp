#include "analysis/geometry/director_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

/// The definition, node by node over all rods and their nearest images.
Vec2 slow_q(const std::vector<Vec3>& positions, const std::vector<Vec3>& directors, double box_side, double smoothing,
            const Vec2& node) {
  Vec2 sum = Vec2::Zero();
  double weight = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double dx = std::remainder(positions[i].x() - node.x(), box_side);
    const double dy = std::remainder(positions[i].y() - node.y(), box_side);
    if (std::abs(dx) > 4 * smoothing || std::abs(dy) > 4 * smoothing) continue;
    const double k = std::exp(-(dx * dx + dy * dy) / (2 * smoothing * smoothing));
    const double theta = std::atan2(directors[i].y(), directors[i].x());
    sum += k * Vec2(std::cos(theta) * std::cos(theta) - 0.5, std::cos(theta) * std::sin(theta));
    weight += k;
  }
  return weight > 0 ? Vec2(sum / weight) : Vec2::Zero();
}

/// The local S, in [0, 1].
double order_at(const DirectorField& field, int i, int j) {
  return std::min(1.0, 2.0 * Vec2(field.q_xx(i, j), field.q_xy(i, j)).norm());
}

TEST(DirectorField, EqualsItsDefinition) {
  Draw draw(41);
  // A box of many smoothing lengths, and one so small that the cut reaches round it.
  for (const double box_side : {20.0, 5.0}) {
    std::vector<Vec3> positions = random_places(draw, 60, box_side);
    const std::vector<Vec3> directors = random_axes(draw, 60);
    const DirectorField field(positions, directors, box_side, 13, 0.9);
    for (int j = 0; j < 13; ++j) {
      for (int i = 0; i < 13; ++i) {
        const Vec2 q = slow_q(positions, directors, box_side, 0.9, field.node(i, j));
        EXPECT_NEAR(field.q_xx(i, j), q.x(), 1e-12);
        EXPECT_NEAR(field.q_xy(i, j), q.y(), 1e-12);
      }
    }
  }
}

TEST(DirectorField, IsPeriodicInRodsAndNodes) {
  Draw draw(43);
  std::vector<Vec3> positions = random_places(draw, 40, 10);
  const std::vector<Vec3> directors = random_axes(draw, 40);
  const DirectorField field(positions, directors, 10, 8, 1.0);
  for (Vec3& p : positions) p += Vec3(-10, 30, 0);
  const DirectorField moved(positions, directors, 10, 8, 1.0);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(field.q_xx(i, 3), moved.q_xx(i, 3), 1e-10);
    EXPECT_EQ(field.q_xy(i - 8, 3 + 16), field.q_xy(i, 3));
  }
}

TEST(DirectorField, IsLinearBetweenNodes) {
  Draw draw(44);
  const DirectorField field(random_places(draw, 40, 10), random_axes(draw, 40), 10, 8, 1.0);
  const double h = field.mesh().x();
  EXPECT_NEAR((field.q_at({3 * h, 9 * h}) - Vec2(field.q_xx(3, 1), field.q_xy(3, 1))).norm(), 0, 1e-14);
  EXPECT_NEAR(field.q_at({-0.25 * h, 2 * h}).x(), 0.25 * field.q_xx(7, 2) + 0.75 * field.q_xx(0, 2), 1e-14);
  EXPECT_NEAR(field.q_at({7.5 * h, 7.5 * h}).y(),
              (field.q_xy(7, 7) + field.q_xy(0, 7) + field.q_xy(7, 0) + field.q_xy(0, 0)) / 4, 1e-14);
}

TEST(DirectorField, WhereNoRodReachesQIsZero) {
  const std::vector<Vec3> positions{{5, 5, 0}, {0, 0, 0}};
  const std::vector<Vec3> directors{axis(0.4), {0, 0, 1}};  // an upright rod weighs nothing
  const DirectorField field(positions, directors, 10, 10, 0.5);
  EXPECT_NEAR(order_at(field, 5, 5), 1.0, 1e-12);
  EXPECT_EQ(order_at(field, 0, 0), 0.0);
  EXPECT_EQ(field.theta(0, 0), 0.0);
}

/// Rods over density of rods per node, by the definition.
double slow_density(const std::vector<Vec3>& positions, const Region& region, int n, double smoothing, const Vec2& at) {
  const auto weight = [&](const Vec2& place) {
    const Vec2 d = region.shortest(place - at).cwiseAbs();
    return d.maxCoeff() > 4 * smoothing ? 0.0 : std::exp(-d.squaredNorm() / (2 * smoothing * smoothing));
  };
  double rods = 0, room = 0, nodes = 0;
  for (const Vec3& p : positions) rods += weight(p.head<2>());
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Vec2 node = Vec2(i, j) * region.box().x() / n;
      if (!region.contains(node)) continue;
      room += weight(node);
      nodes += 1;
    }
  }
  return rods / room * nodes / static_cast<double>(positions.size());
}

// Half the box empty; in arenas too, where half of what a node at the wall sees is no room at all.
TEST(DirectorField, IsUndefinedInTheVoidAndBeyondWalls) {
  constexpr double kBox = 40, kSmoothing = 1.5;
  constexpr int kNodes = 40;
  Draw draw(45);
  for (const Region& region :
       {Region(kBox), Region(kBox, SideWalls{Arena::kDisc, 39}), Region(kBox, SideWalls{Arena::kAnnulus, 39, 15}),
        Region(kBox, SideWalls{Arena::kSquare, 39}),
        Region(kBox, SideWalls{.arena = Arena::kStadium, .size = 25, .length = 14}),
        Region(kBox, SideWalls{.arena = Arena::kEllipse, .size = 28, .length = 39}),
        Region(kBox, SideWalls{.arena = Arena::kWedge, .size = 39, .length = 39, .narrow = 12})}) {
    std::vector<Vec3> positions;
    for (const Vec3& p : random_places(draw, 1500, kBox)) {
      if (region.contains(p.head<2>()) && p.x() < kBox / 2) positions.push_back(p);
    }
    const DirectorField field(positions, random_axes(draw, positions.size()), region, kNodes, kSmoothing);
    int defined = 0, at_walls = 0;
    for (int j = 0; j < kNodes; ++j) {
      for (int i = 0; i < kNodes; ++i) {
        const Vec2 node = field.node(i, j);
        const double density = slow_density(positions, region, kNodes, kSmoothing, node);
        if (std::abs(density - 0.5) < 1e-6) continue;
        EXPECT_EQ(field.is_defined(i, j), region.contains(node) && density > 0.5) << node.transpose();
        defined += field.is_defined(i, j) ? 1 : 0;
        at_walls += field.is_defined(i, j) && !region.contains(node - Vec2(1.5, 0)) ? 1 : 0;
      }
    }
    EXPECT_GT(defined, kNodes * kNodes / 8);
    if (region.has_walls()) {
      EXPECT_GT(at_walls, 8) << "walls do not thin the rods out";
      EXPECT_FALSE(field.is_defined(0, 0));
    }
  }
  EXPECT_FALSE(DirectorField({}, {}, kBox, 8, 1.0).is_defined(3, 3));
}

// Rods along x at the left wall, along y at the right one: 1 mm from either border, they do not meet within walls.
TEST(DirectorField, IsNotSmoothedThroughWalls) {
  const std::vector<Vec3> positions{{1, 20, 0}, {39, 20, 0}, {39, 21, 0}};
  const std::vector<Vec3> directors{axis(0), axis(kPi / 2), axis(kPi / 2)};
  const DirectorField within(positions, directors, Region(40, SideWalls{Arena::kDisc, 39}), 40, 1.5);
  const DirectorField periodic(positions, directors, 40, 40, 1.5);
  const DirectorField channel(positions, directors, Region(40, SideWalls{Arena::kChannel, 39}), 40, 1.5);
  for (int j = 0; j < 40; ++j) EXPECT_EQ(order_at(channel, 0, j), order_at(periodic, 0, j)) << "it has no walls there";
  const auto turned = [](Vec3 v) { return Vec3(v.y(), v.x(), v.z()); };
  std::vector<Vec3> upwards(3), across(3);
  std::ranges::transform(positions, upwards.begin(), turned);
  std::ranges::transform(directors, across.begin(), turned);
  const DirectorField between(upwards, across, Region(40, SideWalls{Arena::kChannel, 39}), 40, 1.5);
  EXPECT_EQ(order_at(between, 20, 1), 1.0);
  EXPECT_EQ(order_at(within, 1, 20), 1.0);
  EXPECT_LT(order_at(periodic, 1, 20), 0.9);
  EXPECT_NEAR(within.theta(1, 20), 0, 1e-12);
  EXPECT_NEAR((within.q_at({-3, 20}) - Vec2(0.5, 0)).norm(), 0, 1e-12) << "beyond the border as at it";
}

TEST(DirectorField, NodesFromMesh) {
  EXPECT_EQ(Grid(10, 0.1).columns, 100);
  EXPECT_EQ(Grid(10, 0.3).rows, 34);
  EXPECT_EQ(Grid(10, 100).rows, 4);
  EXPECT_THROW(Grid(10, 0), std::logic_error);
  EXPECT_THROW(Grid(1e300, 1), std::logic_error);
  EXPECT_THROW(Grid(INFINITY, 1), std::logic_error);
  EXPECT_THROW(Grid(NAN, 1), std::logic_error);
}

}  // namespace
}  // namespace shaken::analysis
