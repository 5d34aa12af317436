#include "analysis/geometry/region.h"

#include <gtest/gtest.h>

#include "tests/support/effort.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace region_test {

constexpr double kBox = 42;

Region disc() { return {kBox, SideWalls{Arena::kDisc, 40}}; }
Region square() { return {kBox, SideWalls{Arena::kSquare, 40}}; }
Region annulus(double inner = 20) { return {kBox, SideWalls{Arena::kAnnulus, 40, inner}}; }

Region stadium(double size = 16, double length = 20) {
  return {kBox, SideWalls{.arena = Arena::kStadium, .size = size, .length = length}};
}
Region ellipse(double size = 20, double length = 40) {
  return {kBox, SideWalls{.arena = Arena::kEllipse, .size = size, .length = length}};
}
Region wedge(double narrow = 0, double size = 24, double length = 32) {
  return {kBox, SideWalls{.arena = Arena::kWedge, .size = size, .length = length, .narrow = narrow}};
}
Region channel() { return {Box(130, kBox), SideWalls{Arena::kChannel, 40}}; }

/// The slow twin: along each of many rays as far as the region goes, in small steps.
double slow_area(const Region& region, const Vec2& place, double radius) {
  constexpr int kRays = 600, kSteps = 1000;
  double area = 0;
  for (int k = 0; k < kRays; ++k) {
    const double phi = 2 * kPi * (k + 0.5) / kRays;
    int step = 0;
    while (step < kSteps &&
           region.contains(place + (step + 0.5) * radius / kSteps * Vec2(std::cos(phi), std::sin(phi))))
      ++step;
    area += kPi / kRays * std::pow(step * radius / kSteps, 2);
  }
  return area;
}

TEST(Region, AreaInSightIsThatOfRaysUpToTheWalls) {
  Draw draw(21);
  for (const Region& region :
       {disc(), square(), annulus(), annulus(2), annulus(34), stadium(), stadium(30, 10), stadium(40, 0),
        stadium(4, 36), channel(), ellipse(), ellipse(40, 40), ellipse(6, 40), wedge(), wedge(8), wedge(0, 40, 10)}) {
    for (int k = 0; k < (test::at_night() ? 6 : 1); ++k) {
      Vec2 place;
      do place = Vec2{draw.uniform(0, kBox), draw.uniform(0, kBox)};
      while (!region.contains(place));
      for (const double radius : {0.5, 3.0, 9.0, 14.0, 21.0, 38.0, 60.0}) {
        const double known = slow_area(region, place, radius);
        EXPECT_NEAR(region.area_in_sight(place, radius) / known, 1, 6e-3) << place.transpose() << " " << radius;
      }
    }
  }
}

TEST(Region, KnownAreasInSight) {
  const Vec2 centre(21, 21);
  EXPECT_NEAR(Region(kBox).area_in_sight(centre, 20), kPi * 400, 1e-9);
  EXPECT_EQ(disc().area_in_sight(centre, 0), 0);
  EXPECT_NEAR(disc().area_in_sight(centre, 12), kPi * 144, 1e-9);
  EXPECT_NEAR(disc().area_in_sight(centre, 30), kPi * 400, 1e-9);
  // All of a disc from its rim; half a lens: two circles of radius R at distance R share R^2 (2 pi / 3 - sqrt(3) / 2).
  EXPECT_NEAR(disc().area_in_sight(Vec2(41, 21), 40), kPi * 400, 1e-9);
  EXPECT_NEAR(disc().area_in_sight(Vec2(41, 21), 20), 400 * (2 * kPi / 3 - std::sqrt(3.0) / 2), 1e-9);
  EXPECT_NEAR(square().area_in_sight(Vec2(1, 1), 10), kPi * 25, 1e-9);
  EXPECT_NEAR(square().area_in_sight(centre, 29), 1600, 1e-9);
  EXPECT_NEAR(square().area_in_sight(Vec2(41, 21), 10), kPi * 50, 1e-9);
  // All of a stadium; a strip of one beside its middle; half of a round end from its middle; all round a place on a
  // straight wall, and up to the other.
  EXPECT_NEAR(stadium().area_in_sight(centre, 20), 320 + 64 * kPi, 1e-9);
  EXPECT_NEAR(stadium().area_in_sight(centre, 5), 25 * kPi, 1e-9);
  EXPECT_NEAR(stadium().area_in_sight(Vec2(31, 21), 8), 64 * kPi, 1e-9);
  EXPECT_NEAR(stadium().area_in_sight(Vec2(21, 29), 10), 50 * kPi, 1e-9);
  EXPECT_NEAR(stadium(40, 0).area_in_sight(Vec2(41, 21), 20), 400 * (2 * kPi / 3 - std::sqrt(3.0) / 2), 1e-9);
  // All of an ellipse, from anywhere; and up to its co-vertices from its centre; of a round one as of a disc; of a flat
  // one, a place on its long axis from which the nearest points are above and below.
  for (const Vec2& place : {centre, Vec2(1, 21), Vec2(21, 31), Vec2(30, 26)}) {
    EXPECT_NEAR(ellipse().area_in_sight(place, 41), 200 * kPi, 1e-9);
  }
  EXPECT_NEAR(ellipse().area_in_sight(centre, 10), 100 * kPi, 1e-9);
  EXPECT_NEAR(ellipse().area_in_sight(centre, 20 - 1e-9), 200 * kPi, 1e-6);
  EXPECT_NEAR(ellipse(40, 40).area_in_sight(Vec2(41, 21), 20), 400 * (2 * kPi / 3 - std::sqrt(3.0) / 2), 1e-7);
  // From a focus at (c, 0) the ellipse is a - e x away, so a circle of radius a reaches beyond it for x > 0. There a
  // ray from the focus sweeps the area a b pi / 2 - b c along the ellipse, by Kepler's equation.
  const double focus = std::sqrt(300), e = focus / 20;
  const double seen = 200 * (kPi / 2) - 10 * focus, angle = std::atan2(10, -focus);
  EXPECT_NEAR(ellipse().area_in_sight(Vec2(21 + focus, 21), 20), seen + 400 * (kPi - angle), 1e-9);
  EXPECT_NEAR(ellipse().area_in_sight(Vec2(21 + focus, 21), 20 * (1 - e)), kPi * std::pow(20 * (1 - e), 2), 1e-9);
  // Of a triangle: all from its tip; half a disc at its wide end; from the tip the sector between its slanting walls.
  EXPECT_NEAR(wedge().area_in_sight(Vec2(37, 21), 40), 384, 1e-9);
  EXPECT_NEAR(wedge().area_in_sight(Vec2(5, 21), 5), 12.5 * kPi, 1e-9);
  EXPECT_NEAR(wedge().area_in_sight(Vec2(37, 21), 30), 900 * std::atan(12.0 / 32), 1e-9);
  EXPECT_NEAR(wedge(24).area_in_sight(Vec2(21, 9), 10), 50 * kPi, 1e-9);
  // Of a channel, a strip of a disc: less two segments of it.
  EXPECT_NEAR(channel().area_in_sight(Vec2(3, 21), 20), 400 * kPi, 1e-9);
  EXPECT_NEAR(channel().area_in_sight(Vec2(3, 21), 40), 1600 * (kPi / 3 + std::sqrt(3.0) / 2), 1e-9);
  // From the outer wall of an annulus 40/20: all but the lens' shadow; from the inner wall a half plane's segment.
  EXPECT_NEAR(annulus().area_in_sight(Vec2(31, 21), 100), 400 * (kPi / 3 - std::sqrt(3.0) / 4), 1e-9);
  EXPECT_NEAR(annulus().area_in_sight(Vec2(36, 21), 5), kPi * 25, 1e-9);
}

TEST(Region, ContainsWhatIsWithinItsWalls) {
  EXPECT_TRUE(Region(kBox).contains({-3, 100}));
  EXPECT_TRUE(disc().contains({40.9, 21}));
  EXPECT_FALSE(disc().contains({41.1, 21}));
  EXPECT_TRUE(square().contains({40.9, 1.1}));
  EXPECT_FALSE(square().contains({0.9, 21}));
  EXPECT_FALSE(annulus().contains({21, 21}));
  EXPECT_TRUE(annulus().contains({31.1, 21}));
  EXPECT_TRUE(stadium().contains({38.9, 21}));
  EXPECT_TRUE(stadium().contains({31, 28.9}));
  EXPECT_FALSE(stadium().contains({38, 26}));
  EXPECT_TRUE(ellipse().contains({40.9, 21}));
  EXPECT_TRUE(ellipse().contains({33, 28.9}));
  EXPECT_FALSE(ellipse().contains({33, 29.1}));
  EXPECT_TRUE(wedge().contains({5.1, 32.8}));
  EXPECT_FALSE(wedge().contains({4.9, 21}));
  EXPECT_TRUE(wedge().contains({21, 26.9}));
  EXPECT_FALSE(wedge().contains({21, 27.1}));
  EXPECT_TRUE(channel().contains({0, 40.9}));
  EXPECT_FALSE(channel().contains({65, 0.9}));
  EXPECT_EQ(annulus().hidden_radius(), 10);
  EXPECT_EQ(disc().hidden_radius(), 0);
}

TEST(Region, WaysGoThroughTheBorderOnlyWhereThereAreNoWalls) {
  EXPECT_EQ(Region(kBox).shortest({40, -2}), Vec2(-2, -2));
  EXPECT_EQ(disc().shortest({38, -2}), Vec2(38, -2));
  EXPECT_EQ(channel().shortest({120, -30}), Vec2(-10, -30)) << "it goes on along x";
  EXPECT_EQ(channel().period(), Vec2(130, 0));
  EXPECT_NEAR(annulus().area(), kPi * 300, 1e-9);
  EXPECT_NEAR(stadium().area(), 320 + 64 * kPi, 1e-9);
  EXPECT_EQ(channel().area(), 130 * 40);
  EXPECT_NEAR(ellipse().area(), 200 * kPi, 1e-9);
  EXPECT_EQ(wedge(8).area(), 16 * 32);
  EXPECT_EQ(Region(kBox).area(), kBox * kBox);
}

}  // namespace region_test
}  // namespace shaken::analysis
