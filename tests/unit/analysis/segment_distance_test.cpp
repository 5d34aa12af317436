#include "analysis/geometry/segment_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/contact/bead_contacts.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

TEST(SegmentDistance, ByHand) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
  EXPECT_EQ(segment_distance(o, o, Vec3(3, 4, 0), o), 5);                         // points
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(1, 3, 0), o), 3);                     // a point beside
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(5, 4, 0), o), 5);                     // and beyond the end
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(1, -1, 0.5), 2 * y), 0.5);            // crossing, one above the other
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(1, 2, 0), 2 * y), 2);                 // a T
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(1, 0.75, 0), 2 * x), 0.75);           // side by side
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(5, 4, 0), 2 * x), 5);                 // one behind the other
  EXPECT_EQ(segment_distance(o, 2 * x, Vec3(1, 0, 0), 2 * x), 0);                 // on each other
  EXPECT_EQ(segment_distance(Vec3(2, 0, 0), -2 * x, Vec3(-3, 4, 0), -1 * x), 5);  // the other way round
}

// Twins: the simulation's own, written for centres and half-lengths, and the smallest distance of many points.
TEST(SegmentDistance, OfRandomSegments) {
  Draw draw(341);
  const auto vector = [&](double size) {
    return Vec3(size * draw.normal(), size * draw.normal(), 0.3 * size * draw.normal());
  };
  for (int i = 0; i < 3000; ++i) {
    const Vec3 a = vector(1), b = vector(1), u = vector(1);
    const Vec3 w = i % 4 == 0 ? Vec3(draw.uniform(-2, 2) * u) : vector(1);  // many are parallel
    const double found = segment_distance(a, u, b, w);
    const double theirs = std::sqrt(
        segment_distance_squared(b + w / 2 - a - u / 2, u.normalized(), u.norm() / 2, w.normalized(), w.norm() / 2));
    EXPECT_NEAR(found, theirs, 1e-7);
    EXPECT_NEAR(found, segment_distance(b, w, a, u), 1e-7);
    if (i >= 100) continue;
    double least = 1e9;
    for (int k = 0; k <= 200; ++k) {
      for (int l = 0; l <= 200; ++l) least = std::min(least, (a + k / 200.0 * u - b - l / 200.0 * w).norm());
    }
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(found, least - (u.norm() + w.norm()) / 400);
  }
}

}  // namespace
}  // namespace shaken::analysis
