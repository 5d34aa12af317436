#include "sim/motion/ellipse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/effort.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

Vec2 point_at(double a, double b, double angle) { return {a * std::cos(angle), b * std::sin(angle)}; }

/// The slow twin: the nearest of many points of the ellipse, and between its neighbours by golden section.
double slow_distance(double a, double b, const Vec2& point) {
  constexpr int kPoints = 2000;
  const auto distance = [&](double angle) { return (point_at(a, b, angle) - point).norm(); };
  int best = 0;
  for (int k = 1; k < kPoints; ++k) {
    if (distance(2 * kPi * k / kPoints) < distance(2 * kPi * best / kPoints)) best = k;
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double low = 2 * kPi * (best - 1) / kPoints, high = 2 * kPi * (best + 1) / kPoints;
  for (int step = 0; step < 60; ++step) {
    const double left = high - golden * (high - low), right = low + golden * (high - low);
    (distance(left) < distance(right) ? high : low) = distance(left) < distance(right) ? right : left;
  }
  const double inside = std::pow(point.x() / a, 2) + std::pow(point.y() / b, 2);
  return (inside <= 1 ? 1 : -1) * distance(0.5 * (low + high));
}

TEST(Ellipse, KnownDistancesAndNormals) {
  const Ellipse ellipse(5, 3);  // the discs at its tips are about (+-3.2, 0), of radius 1.8
  const auto expect = [&](const Vec2& point, double distance, const Vec2& normal) {
    const auto seen = ellipse.see(point);
    EXPECT_NEAR(seen.distance, distance, 1e-15) << point.transpose();
    EXPECT_LT((seen.normal - normal).norm(), 1e-15) << point.transpose();
  };
  expect({0, 0}, 3, {0, -1});
  expect({0, 2}, 1, {0, -1});
  expect({0, -2.5}, 0.5, {0, 1});
  expect({0, 7}, -4, {0, -1});
  expect({4, 0}, 1, {-1, 0});
  expect({-4.5, 0}, 0.5, {1, 0});
  expect({9, 0}, -4, {-1, 0});
  expect({3.2, 0}, 1.8, {-1, 0});
  // between the tips' discs the nearest points are above and below, at x a^2 / (a^2 - b^2)
  expect({1.6, 0}, 3 * std::sqrt(1 - 0.25 * 0.64), Vec2(-0.3, -std::sqrt(0.75)).normalized());
  const Ellipse circle(2, 2);
  EXPECT_EQ(circle.see({0, 0}).distance, 2);
  EXPECT_NEAR(circle.see({0.6, -0.8}).distance, 1, 1e-15);
  EXPECT_LT((circle.see({0.6, -0.8}).normal - Vec2(-0.6, 0.8)).norm(), 1e-15);
}

// Along the normal of any of its points, inwards as far as the centre of the disc that touches there.
TEST(Ellipse, SeesThePointFromWhichOneComesAlongTheNormal) {
  test::Draw draw(41);
  double worst_normal = 0;
  for (int trial = 0; trial < test::draws(200000); ++trial) {
    const double a = draw.uniform(1, 100);
    const double b = a * (draw.integer(0, 5) ? draw.uniform(0.1, 1) : 1 - std::pow(10, draw.uniform(-16, -1)));
    const double angle = draw.integer(0, 3) ? draw.uniform(0, 2 * kPi) : std::pow(10, draw.uniform(-18, -1));
    const Vec2 at = point_at(a, b, angle);
    const Vec2 normal = -Vec2(at.x() / (a * a), at.y() / (b * b)).normalized();
    const Ellipse ellipse(a, b);
    const double radius = ellipse.disc_at(at.x() / a).radius;
    const double part = draw.integer(0, 3) ? draw.uniform(-2, 1) : std::pow(10, draw.uniform(-18, 0));
    const auto seen = ellipse.see(at + part * radius * normal);
    ASSERT_NEAR(seen.distance, part * radius, 2e-15 * a)
        << trial << " " << a << " " << b << " " << angle << " " << part;
    ASSERT_NEAR(seen.normal.norm(), 1, 1e-14);
    if (part > 0.8) continue;  // further on the way back is lost in rounding
    worst_normal = std::max(worst_normal, (seen.normal - normal).norm());
    ASSERT_LT((seen.normal - normal).norm(), 1e-13) << trial << " " << a << " " << b << " " << angle << " " << part;
  }
  std::printf("worst normal %.2g\n", worst_normal);
}

TEST(Ellipse, SeesTheNearestOfManyPoints) {
  test::Draw draw(42);
  for (int trial = 0; trial < test::draws(2000); ++trial) {
    const double b = draw.uniform(0.5, 4), a = draw.integer(0, 4) ? draw.uniform(b, 20) : b;
    Vec2 point(draw.uniform(-1.3 * a, 1.3 * a), draw.uniform(-1.3 * b, 1.3 * b));
    if (!draw.integer(0, 4)) point[draw.integer(0, 1)] = draw.integer(0, 1) ? 0 : std::pow(10, draw.uniform(-300, -3));
    EXPECT_NEAR(Ellipse(a, b).see(point).distance, slow_distance(a, b, point), 1e-13 * a)
        << a << " " << b << " " << point;
  }
}

TEST(Ellipse, ItsDiscsLieWithinItAndTheNearestIsTheDeepest) {
  test::Draw draw(43);
  for (int trial = 0; trial < test::draws(2000); ++trial) {
    const double b = draw.uniform(0.5, 4), a = draw.uniform(b, 20);
    const Ellipse ellipse(a, b);
    const Ellipse::Disc disc = ellipse.disc_at(draw.uniform(-1, 1));
    for (int k = 0; k < 200; ++k) ASSERT_LE(disc.depth(point_at(a, b, 2 * kPi * k / 200)), 1e-14 * a);
    const Vec2 point(draw.uniform(-a, a), draw.uniform(-b, b));
    const double distance = ellipse.see(point).distance;
    ASSERT_LE(disc.depth(point), distance + 1e-14 * a);
    ASSERT_LE(ellipse.disc_round(point).depth(point), distance + 1e-14 * a);
    const Vec2 on_it = point_at(a, b, draw.uniform(0, 2 * kPi));
    EXPECT_NEAR(ellipse.disc_round(on_it).depth(on_it), 0, 1e-14 * a);
  }
}

TEST(Ellipse, MirrorImagesSeeMirrorImages) {
  test::Draw draw(44);
  const Ellipse ellipse(17, 6);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec2 point(draw.uniform(0.1, 15), draw.uniform(0.1, 5));
    const auto seen = ellipse.see(point);
    for (const Vec2& way : {Vec2(-1, 1), Vec2(1, -1), Vec2(-1, -1)}) {
      const auto image = ellipse.see(way.cwiseProduct(point));
      EXPECT_EQ(image.distance, seen.distance);
      EXPECT_EQ(image.normal, Vec2(way.cwiseProduct(seen.normal)));
    }
  }
}

}  // namespace
}  // namespace shaken
