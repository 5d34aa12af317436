#include "analysis/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/contact/bead_contacts.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace clusters_test {

constexpr double kBox = 20;
constexpr ClusterRule kRule{.distance = 1};
constexpr RodAxis kAxis[]{{.tail = 2, .head = 2}};
using Sizes = std::vector<std::size_t>;

TEST(ClusterSizes, OfRodsPlacedByHand) {
  const auto sizes = [](std::vector<Vec3> places, std::vector<Vec3> directors) {
    return cluster_sizes(places, directors, kAxis, kBox, kRule);
  };
  EXPECT_EQ(sizes({}, {}), Sizes{});
  EXPECT_EQ(sizes({{5, 5, 0}}, {axis(0)}), Sizes{1});
  // side by side, and one too far
  EXPECT_EQ(sizes({{5, 5, 0}, {5, 5.9, 0}, {5, 7, 0}}, {axis(0), axis(kPi), axis(0)}), (Sizes{2, 1}));
  // a row of three of which the ends do not touch
  EXPECT_EQ(sizes({{5, 5, 0}, {5, 5.9, 0}, {5, 6.8, 0}}, {axis(0), axis(0), axis(0)}), Sizes{3});
  // tip to tip: centres are 4.9 apart
  EXPECT_EQ(sizes({{5, 5, 0}, {9.9, 5, 0}}, {axis(0), axis(0)}), Sizes{2});
  EXPECT_EQ(sizes({{5, 5, 0}, {10.1, 5, 0}}, {axis(0), axis(0)}), (Sizes{1, 1}));
  // crossed, one above the other
  EXPECT_EQ(sizes({{5, 5, 0}, {5, 5, 0.9}}, {axis(0), axis(1)}), Sizes{2});
  EXPECT_EQ(sizes({{5, 5, 0}, {5, 5, 1.1}}, {axis(0), axis(1)}), (Sizes{1, 1}));
  // across the border and the corner of the box
  EXPECT_EQ(sizes({{19.8, 19.8, 0}, {0.3, 0.3, 0}}, {axis(0), axis(0)}), Sizes{2});
  EXPECT_EQ(sizes({{19, 5, 0}, {3, 5, 0}, {11, 5, 0}}, {axis(0), axis(0), axis(0)}), (Sizes{2, 1}));
}

TEST(ClusterSizes, KnowWallsHeadsAndAngles) {
  // Walls: no images.
  const Region square(kBox, SideWalls{Arena::kSquare, 19.9});
  const std::vector<Vec3> corners{{19.8, 19.8, 0}, {0.3, 0.3, 0}}, along{axis(0), axis(0)};
  EXPECT_EQ(cluster_sizes(corners, along, kAxis, square, kRule), (Sizes{1, 1}));
  const Region channel(kBox, SideWalls{Arena::kChannel, 19.9});
  EXPECT_EQ(cluster_sizes(corners, along, kAxis, channel, kRule), (Sizes{1, 1}));
  EXPECT_EQ(cluster_sizes(std::vector<Vec3>{{19.8, 5, 0}, {0.3, 5, 0}}, along, kAxis, channel, kRule), Sizes{2});
  // The head is farther from the centre of mass than the tail: heads touch, tails do not.
  const RodAxis polar[]{{.tail = 1, .head = 3}};
  const std::vector<Vec3> apart{{5, 5, 0}, {11.5, 5, 0}};
  EXPECT_EQ(cluster_sizes(apart, std::vector<Vec3>{axis(0), axis(kPi)}, polar, kBox, kRule), Sizes{2});
  EXPECT_EQ(cluster_sizes(apart, std::vector<Vec3>{axis(kPi), axis(0)}, polar, kBox, kRule), (Sizes{1, 1}));
  // Axes may differ by 0.3 and no more, whichever way they point.
  ClusterRule aligned = kRule;
  aligned.angle = 0.3;
  const std::vector<Vec3> near{{5, 5, 0}, {5, 5.5, 0}};
  EXPECT_EQ(cluster_sizes(near, std::vector<Vec3>{axis(0), axis(kPi + 0.29)}, kAxis, kBox, aligned), Sizes{2});
  EXPECT_EQ(cluster_sizes(near, std::vector<Vec3>{axis(0), axis(0.31)}, kAxis, kBox, aligned), (Sizes{1, 1}));
  EXPECT_EQ(cluster_sizes(near, std::vector<Vec3>{axis(0), axis(kPi / 2)}, kAxis, kBox, kRule), Sizes{2});
}

// The slow twin looks at all pairs and all images of each, and walks from rod to rod.
Sizes slow_sizes(const std::vector<Vec3>& places, const std::vector<Vec3>& directors, const std::vector<RodAxis>& axes,
                 const ClusterRule& rule) {
  const std::size_t n = places.size();
  const auto are_neighbours = [&](std::size_t i, std::size_t j) {
    if (std::acos(std::min(1.0, std::abs(directors[i].dot(directors[j])))) > rule.angle) return false;
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b) {
        const Vec3 from = places[i] - axes[i].tail * directors[i];
        const Vec3 to = places[j] - axes[j].tail * directors[j] + kBox * Vec3(a, b, 0);
        const Vec3 along = (axes[i].tail + axes[i].head) * directors[i];
        const Vec3 other = (axes[j].tail + axes[j].head) * directors[j];
        if (segment_distance(from, along, to, other) < rule.distance) return true;
      }
    }
    return false;
  };
  std::vector<bool> seen(n);
  Sizes sizes;
  for (std::size_t first = 0; first < n; ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> cluster{first};
    seen[first] = true;
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      for (std::size_t j = 0; j < n; ++j) {
        if (seen[j] || !are_neighbours(cluster[k], j)) continue;
        seen[j] = true;
        cluster.push_back(j);
      }
    }
    sizes.push_back(cluster.size());
  }
  std::ranges::sort(sizes, std::greater());
  return sizes;
}

TEST(ClusterSizes, EqualThoseOfTheWalk) {
  Draw draw(351);
  for (const std::size_t n : {3u, 20u, 40u, 80u}) {
    for (const double distance : {0.2, 0.5, 0.9}) {
      for (const double angle : {kPi / 2, 0.5}) {
        const ClusterRule rule{.distance = distance, .angle = angle};
        const std::vector<Vec3> places = random_places(draw, n, kBox), directors = random_axes(draw, n);
        std::vector<RodAxis> axes(n, {.tail = 0.7, .head = 1.1});
        EXPECT_EQ(cluster_sizes(places, directors, std::span(axes).first(1), kBox, rule),
                  slow_sizes(places, directors, axes, rule))
            << n;
        for (RodAxis& axis : axes) axis = {draw.uniform(0.1, 1), draw.uniform(0.1, 1.5)};
        EXPECT_EQ(cluster_sizes(places, directors, axes, kBox, rule), slow_sizes(places, directors, axes, rule)) << n;
      }
    }
  }
}

TEST(ClusterStatistics, OfSizesByHand) {
  ClusterStatistics statistics;
  statistics.accumulate({5, 2, 1, 1, 1});  // ten rods
  statistics.accumulate({7, 3});
  statistics.accumulate({});
  const ClusterNumbers found = statistics.reduce();
  EXPECT_NEAR(found.largest, (0.5 + 0.7) / 2, 1e-15);
  EXPECT_NEAR(found.size, (25 + 4 + 3 + 49 + 9) / 20.0, 1e-14);
  EXPECT_NEAR(found.alone, 3 / 20.0, 1e-15);
  EXPECT_NEAR(found.per_rod, 7 / 20.0, 1e-15);
  EXPECT_NEAR(found.rods[0], 3 / 20.0, 1e-15);
  EXPECT_NEAR(found.rods[1], 5 / 20.0, 1e-15);   // of 2 and 3
  EXPECT_NEAR(found.rods[2], 12 / 20.0, 1e-15);  // of 4 to 7
  EXPECT_EQ(found.rods[3], 0);
  EXPECT_NEAR(found.density[0], 3 / 20.0, 1e-15);
  EXPECT_NEAR(found.density[1], 2 / 20.0 / 2, 1e-15);
  EXPECT_NEAR(found.density[2], 2 / 20.0 / 4, 1e-15);
  EXPECT_TRUE(std::isnan(ClusterStatistics().reduce().largest));
  EXPECT_TRUE(std::isnan(ClusterStatistics().reduce().rods[0]));
}

TEST(ClusterSeries, KeepsLargestAndMean) {
  ClusterSeries series;
  series.accumulate(1, {3, 1});
  series.accumulate(2, {2, 2});
  EXPECT_EQ(series.times(), (std::vector<double>{1, 2}));
  EXPECT_EQ(series.largest(), (std::vector<double>{0.75, 0.5}));
  EXPECT_EQ(series.sizes(), (std::vector<double>{2.5, 2}));
}

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

}  // namespace clusters_test
}  // namespace shaken::analysis
