#include "analysis/defects.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

constexpr double kBox = 60.0;
const double kWave = 2 * kPi / kBox;

/// (cos 2 theta, sin 2 theta) up to its length, periodic, with one zero of either sign: +1/2 at x = -L/4, -1/2 at L/4
/// from `centre`. Turning it by `phase` turns theta by phase / 2 everywhere.
Vec2 one_pair(const Vec2& p, const Vec2& centre, double phase) {
  const double x = kWave * (p.x() - centre.x()), y = kWave * (p.y() - centre.y());
  const Vec2 q(std::cos(x) + std::cos(y) - 1, std::sin(y));
  return {std::cos(phase) * q.x() - std::sin(phase) * q.y(), std::sin(phase) * q.x() + std::cos(phase) * q.y()};
}

struct Rods {
  std::vector<Vec3> positions, directors;
};

/// `n` rods at random places along the planted director, with Gaussian spread.
Rods plant(Draw& draw, std::size_t n, double spread, const std::function<Vec2(const Vec2&)>& q) {
  Rods rods{random_places(draw, n, kBox), {}};
  for (const Vec3& p : rods.positions) {
    const Vec2 local = q(p.head<2>());
    rods.directors.push_back(
        axis(0.5 * std::atan2(local.y(), local.x()) + spread * draw.normal(), draw.uniform(-0.2, 0.2)));
  }
  return rods;
}

double distance(const Vec2& a, const Vec2& b) {
  return std::hypot(std::remainder(a.x() - b.x(), kBox), std::remainder(a.y() - b.y(), kBox));
}

double total_charge(const std::vector<Defect>& defects) {
  return std::accumulate(defects.begin(), defects.end(), 0.0,
                         [](double sum, const Defect& d) { return sum + d.charge; });
}

// One pair, wherever the centre lies in the mesh and however the pattern is turned. Round the +1/2 at -L/4 the doubled
// angle is phi + phase, so the director is radial at phi = phase; round the -1/2 it is pi - phi + phase, radial at
// (pi + phase) / 3 and a third of a turn on. A swapped sign, or a prefactor 1 for -1/2, misses the direction by
// radians.
TEST(Defects, OnePlantedPair) {
  Draw draw(51);
  for (int k = 0; k < 12; ++k) {
    const Vec2 centre{draw.uniform(0, kBox), draw.uniform(0, kBox)};
    const double phase = draw.uniform(-kPi, kPi);
    const Rods rods = plant(draw, 4000, 0.1, [&](const Vec2& p) { return one_pair(p, centre, phase); });
    const DirectorField field(rods.positions, rods.directors, kBox, 100, 2.0);
    const std::vector<Defect> defects = find_defects(field);
    ASSERT_EQ(defects.size(), 2u);
    const Defect& plus = defects[0].charge > 0 ? defects[0] : defects[1];
    const Defect& minus = defects[0].charge > 0 ? defects[1] : defects[0];
    EXPECT_EQ(plus.charge, 0.5);
    EXPECT_EQ(minus.charge, -0.5);
    EXPECT_LT(distance(plus.position, centre - Vec2(kBox / 4, 0)), 2 * field.mesh().x());
    EXPECT_LT(distance(minus.position, centre + Vec2(kBox / 4, 0)), 2 * field.mesh().x());
    EXPECT_NEAR(std::remainder(plus.direction - phase, 2 * kPi), 0, 0.12);
    EXPECT_NEAR(std::remainder(minus.direction - (kPi + phase) / 3, 2 * kPi / 3), 0, 0.12);
    for (const Defect& d : defects) {
      EXPECT_TRUE((d.position.array() >= 0).all() && (d.position.array() < kBox).all());
      EXPECT_LE(std::abs(d.direction), d.charge > 0 ? kPi : kPi / 3);
    }
  }
}

// The lattice sin x + i sin y has two of either sign; a rod on every node and hardly any smoothing leaves only the
// interpolation, so places are good to a tenth of the mesh and directions to a hundredth of a radian.
TEST(Defects, FourOfALatticeToAFractionOfTheMesh) {
  constexpr int kNodes = 48;
  constexpr double kMesh = kBox / kNodes;
  const Vec2 origin(10.3, 7.7);
  Rods rods;
  for (int j = 0; j < kNodes; ++j) {
    for (int i = 0; i < kNodes; ++i) {
      rods.positions.push_back({i * kMesh, j * kMesh, 0});
      rods.directors.push_back(axis(
          0.5 * std::atan2(std::sin(kWave * (j * kMesh - origin.y())), std::sin(kWave * (i * kMesh - origin.x())))));
    }
  }
  const DirectorField field(rods.positions, rods.directors, kBox, kNodes, 0.6 * kMesh);
  const std::vector<Defect> defects = find_defects(field);
  ASSERT_EQ(defects.size(), 4u);
  const Vec2 half_x(kBox / 2, 0), half_y(0, kBox / 2);
  const std::vector<Defect> expected{{origin, 0.5, 0.0},
                                     {origin + half_x, -0.5, kPi / 3},
                                     {origin + half_y, -0.5, 0.0},
                                     {origin + half_x + half_y, 0.5, kPi}};
  for (const Defect& planted : expected) {
    const auto found = std::find_if(defects.begin(), defects.end(), [&](const Defect& d) {
      return distance(d.position, planted.position) < 0.2 * kMesh;
    });
    ASSERT_NE(found, defects.end()) << planted.position.transpose();
    EXPECT_EQ(found->charge, planted.charge);
    EXPECT_NEAR(std::remainder(found->direction - planted.direction, kPi / (1 - planted.charge)), 0, 0.02);
  }
}

// A pair in a box with a hole in which single rods stray: none in the hole, where before there were, and the pair is
// the same as in the full box.
TEST(Defects, NoneInTheVoid) {
  Draw draw(54);
  const Vec2 centre(kBox / 2, kBox / 2), hole(kBox / 2, 0);
  const double radius = kBox / 5;
  Rods full = plant(draw, 4000, 0.1, [&](const Vec2& p) { return one_pair(p, centre, 0.7); });
  Rods holed;
  int strays = 0;
  for (std::size_t i = 0; i < full.positions.size(); ++i) {
    if (distance(full.positions[i].head<2>(), hole) < radius) {
      if (strays++ % 40 != 0) continue;
      full.directors[i] = axis(draw.uniform(-kPi, kPi));
    }
    holed.positions.push_back(full.positions[i]);
    holed.directors.push_back(full.directors[i]);
  }
  ASSERT_GT(strays, 200);
  const std::vector<Defect> defects = find_defects(DirectorField(holed.positions, holed.directors, kBox, 100, 2.0));
  ASSERT_EQ(defects.size(), 2u);
  for (const Defect& defect : defects) {
    EXPECT_LT(distance(defect.position, centre - (defect.charge > 0 ? 1 : -1) * Vec2(kBox / 4, 0)), 1.0);
  }
  // Without a floor the strays make some.
  const DirectorField field(holed.positions, holed.directors, kBox, 100, 2.0);
  int wound = 0;
  for (int j = 0; j < field.grid().rows; ++j) {
    for (int i = 0; i < field.grid().rows; ++i) {
      const double round[] = {field.theta(i, j), field.theta(i + 1, j), field.theta(i + 1, j + 1),
                              field.theta(i, j + 1), field.theta(i, j)};
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += std::remainder(round[k + 1] - round[k], kPi);
      if (std::abs(sum) > kPi / 2) ++wound;
    }
  }
  EXPECT_GT(wound, 2);
}

// Planted in the middle of every kind of arena: theta = phi / 2 about the centre of a disc is one +1/2.
TEST(Defects, InAnArena) {
  Draw draw(55);
  const Region region(kBox, SideWalls{Arena::kDisc, kBox - 1});
  const Vec2 centre(kBox / 2, kBox / 2), off = centre + Vec2(kBox / 8, 0);
  Rods rods;
  while (rods.positions.size() < 3000) {
    const Vec3 place{draw.uniform(0, kBox), draw.uniform(0, kBox), 0};
    if (!region.contains(place.head<2>())) continue;
    const Vec2 d = place.head<2>() - off;
    rods.positions.push_back(place);
    rods.directors.push_back(axis(0.5 * std::atan2(d.y(), d.x()) + 0.1 * draw.normal()));
  }
  const std::vector<Defect> defects = find_defects(DirectorField(rods.positions, rods.directors, region, 100, 1.5));
  ASSERT_EQ(defects.size(), 1u) << "no other, though directors at opposite walls do not match: "
                                << defects.back().position.transpose();
  EXPECT_EQ(defects[0].charge, 0.5);
  EXPECT_LT((defects[0].position - off).norm(), 1.0);
  EXPECT_NEAR(defects[0].direction, 0, 0.15);
}

// theta = phi / 2 about a place beside the border of a channel, where it goes on; the directors turn by half a turn
// along it, so that they match there. Seen across the border there is one defect, and none along the walls.
TEST(Defects, InAChannelAcrossItsBorder) {
  Draw draw(57);
  const Region region(kBox, SideWalls{Arena::kChannel, kBox - 1});
  Rods rods;
  while (rods.positions.size() < 3000) {
    const Vec3 place{draw.uniform(0, kBox), draw.uniform(0, kBox), 0};
    if (!region.contains(place.head<2>())) continue;
    // a defect at x = 0.2 and its opposite half a box away
    const Vec2 d(std::sin(2 * kPi * (place.x() - 0.2) / kBox), 2 * kPi * (place.y() / kBox - 0.5));
    rods.positions.push_back(place);
    rods.directors.push_back(axis(0.5 * std::atan2(d.y(), d.x()) + 0.05 * draw.normal()));
  }
  const std::vector<Defect> defects = find_defects(DirectorField(rods.positions, rods.directors, region, 100, 1.5));
  ASSERT_EQ(defects.size(), 2u);
  const bool is_first = defects[0].charge > 0;
  const Defect &plus = defects[is_first ? 0 : 1], &minus = defects[is_first ? 1 : 0];
  EXPECT_LT(region.shortest(plus.position - Vec2(0.2, kBox / 2)).norm(), 1.0);
  EXPECT_LT(region.shortest(minus.position - Vec2(0.2 + kBox / 2, kBox / 2)).norm(), 1.0);
  EXPECT_EQ(plus.charge + minus.charge, 0);
}

TEST(Defects, NoneInAnOrderedStateWithNoise) {
  Draw draw(52);
  const Rods rods = plant(draw, 4000, 0.4, [](const Vec2&) { return Vec2(-1, 0.1); });
  EXPECT_TRUE(find_defects(DirectorField(rods.positions, rods.directors, kBox, 80, 2.0)).empty());
}

// Two crossed rods at node (0, 0) leave no Q there, and the three others of the last plaquette wind round it: the zero
// of Q lies exactly on the corner of the box, which belongs to the low side.
TEST(Defects, OnTheCornerOfTheBoxBelongsInside) {
  const std::vector<Vec3> positions{{3, 3, 0}, {0, 3, 0}, {3, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const std::vector<Vec3> directors{{0, 1, 0}, {1, -1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Defect> defects = find_defects(DirectorField(positions, directors, 4, 4, 0.1));
  EXPECT_NE(std::find_if(defects.begin(), defects.end(), [](const Defect& d) { return d.position == Vec2(0, 0); }),
            defects.end());
  for (const Defect& d : defects) EXPECT_LT(d.position.maxCoeff(), 4.0);
}

/// Defects counted by the textbook recipe: sum of the four folded steps over 2 pi.
int slow_count(const DirectorField& field, double sign) {
  int count = 0;
  for (int j = 0; j < field.grid().rows; ++j) {
    for (int i = 0; i < field.grid().rows; ++i) {
      if (!(field.is_defined(i, j) && field.is_defined(i + 1, j) && field.is_defined(i + 1, j + 1) &&
            field.is_defined(i, j + 1))) {
        continue;
      }
      const double round[] = {field.theta(i, j), field.theta(i + 1, j), field.theta(i + 1, j + 1),
                              field.theta(i, j + 1), field.theta(i, j)};
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += std::remainder(round[k + 1] - round[k], kPi);
      if (sum * sign > kPi / 2) ++count;
    }
  }
  return count;
}

TEST(Defects, OfRandomRodsCancelAndAreThoseOfTheTextbook) {
  Draw draw(53);
  int n_everywhere = 0;  // fields without a place that is too sparse for a director
  for (int k = 0; k < 20; ++k) {
    const std::vector<Vec3> positions = random_places(draw, 2000, kBox);
    const DirectorField field(positions, random_axes(draw, 2000), kBox, 24, 2.0);
    const std::vector<Defect> defects = find_defects(field);
    EXPECT_GT(defects.size(), 4u);
    bool everywhere = true;
    for (int node = 0; node < 24 * 24; ++node) everywhere = everywhere && field.is_defined(node % 24, node / 24);
    n_everywhere += everywhere;
    if (everywhere) {
      EXPECT_EQ(total_charge(defects), 0.0);
    }
    EXPECT_EQ(std::count_if(defects.begin(), defects.end(), [](const Defect& d) { return d.charge > 0; }),
              slow_count(field, 1));
    EXPECT_EQ(std::count_if(defects.begin(), defects.end(), [](const Defect& d) { return d.charge < 0; }),
              slow_count(field, -1));
  }
  EXPECT_GE(n_everywhere, 10);
}

// Angles that are multiples of pi/4 make neighbours exactly perpendicular, where the two ways round are equally short.
// Sparse rods leave nodes without a director; elsewhere the charges cancel.
TEST(Defects, TotalChargeIsZeroForAnyFieldThatIsDefinedEverywhere) {
  EXPECT_TRUE(rc::check("neutral", [](std::uint64_t seed) {
    Draw draw(seed);
    const int n = *rc::gen::inRange(2, 20);
    const auto n_rods = static_cast<std::size_t>(*rc::gen::inRange(0, 600));
    const bool right_angles = *rc::gen::arbitrary<bool>();
    const std::vector<Vec3> axes{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, -1, 0}, {0, 0, 1}};
    std::vector<Vec3> directors = random_axes(draw, n_rods);
    if (right_angles) {
      for (Vec3& d : directors) d = axes[static_cast<std::size_t>(draw.uniform(0, 5))];
    }
    const double smoothing = draw.uniform(0.1, 10);
    const DirectorField field(random_places(draw, n_rods, kBox), directors, kBox, n, smoothing);
    const std::vector<Defect> defects = find_defects(field);
    bool everywhere = true;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) everywhere = everywhere && field.is_defined(i, j);
    }
    RC_CLASSIFY(everywhere);
    if (everywhere) RC_ASSERT(total_charge(defects) == 0.0);
    for (const Defect& d : defects) {
      RC_ASSERT((d.position.array() >= 0).all() && (d.position.array() < kBox).all());
      RC_ASSERT(std::abs(d.direction) <= kPi);
    }
  }));
}

}  // namespace
}  // namespace shaken::analysis
