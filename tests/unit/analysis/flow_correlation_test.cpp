#include "analysis/flow_correlation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace flow_correlation_test {

constexpr double kBox = 20;

std::vector<Vec2> random_places_2d(Draw& draw, std::size_t n) {
  std::vector<Vec2> places;
  for (std::size_t i = 0; i < n; ++i) places.push_back({draw.uniform(0, kBox), draw.uniform(0, kBox)});
  return places;
}

FlowCurve curve_of(const std::vector<Vec2>& places, const std::vector<Vec2>& velocities, double director,
                   const Region& region = kBox, int bins = 10, double near = 1) {
  FlowSums sums(bins, kBox / 2, near);
  sums.accumulate(places, velocities, director, region);
  return sums.reduce();
}

/// Places on a fine square lattice: sums over pairs become integrals.
std::vector<Vec2> lattice(int n) {
  std::vector<Vec2> places;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) places.push_back({(i + 0.5) * kBox / n, (j + 0.5) * kBox / n});
  }
  return places;
}

// v = (0, cos q x): <v(r') v(r' + r)> / <v^2> averaged over directions of r is J_0(q r). Along the director, which is
// x, nothing moves.
TEST(FlowSums, OfAWaveIsABesselFunction) {
  const std::vector<Vec2> places = lattice(32);
  const double q = 2 * kPi / kBox;
  std::vector<Vec2> velocities;
  for (const Vec2& place : places) velocities.push_back({0, std::cos(q * place.x())});
  const FlowCurve curve = curve_of(places, velocities, 0, kBox, 10);
  for (std::size_t bin = 0; bin < 10; ++bin) {
    EXPECT_NEAR(curve.r[bin], static_cast<double>(bin) + 0.5, 1e-12);
    EXPECT_NEAR(curve.c[bin], std::cyl_bessel_j(0, q * curve.r[bin]), 0.03);
    EXPECT_NEAR(curve.across[bin], curve.c[bin], 1e-12);
    EXPECT_TRUE(std::isnan(curve.along[bin]));
  }
  // J_0(x) = 1/e at x = 1.7464
  EXPECT_NEAR(curve.length, 1.7464 / q, 0.15);
}

// The slow twin tries all nine images of every pair.
TEST(FlowSums, EqualsTheSumOverAllPairs) {
  constexpr int kBins = 9;
  constexpr double kDirector = 2.2, kNear = 3;
  Draw draw(334);
  const std::vector<Vec2> places = random_places_2d(draw, 40);
  std::vector<Vec2> velocities;
  for (int i = 0; i < 40; ++i) velocities.push_back({draw.normal(), 0.4 * draw.normal()});
  const FlowCurve curve = curve_of(places, velocities, kDirector, kBox, kBins, kNear);
  const Vec2 n(std::cos(kDirector), std::sin(kDirector)), m(-n.y(), n.x());
  std::vector<double> pairs(kBins), along(kBins), across(kBins);
  double along_square = 0, across_square = 0, near = 0, near_pairs = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    along_square += std::pow(velocities[i].dot(n), 2) / 40;
    across_square += std::pow(velocities[i].dot(m), 2) / 40;
    for (std::size_t j = 0; j < 40; ++j) {
      if (i == j) continue;
      double distance = 1e9;
      for (int a = -1; a <= 1; ++a) {
        for (int b = -1; b <= 1; ++b) {
          distance = std::min(distance, (places[i] - places[j] + kBox * Vec2(a, b)).norm());
        }
      }
      if (distance < kNear) {
        near_pairs += 1;
        near += velocities[i].dot(velocities[j]);
      }
      const auto bin = static_cast<std::size_t>(distance / (kBox / 2 / kBins));
      if (bin >= kBins) continue;
      pairs[bin] += 1;
      along[bin] += velocities[i].dot(n) * velocities[j].dot(n);
      across[bin] += velocities[i].dot(m) * velocities[j].dot(m);
    }
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    EXPECT_NEAR(curve.c[bin], (along[bin] + across[bin]) / pairs[bin] / (along_square + across_square), 1e-12);
    EXPECT_NEAR(curve.along[bin], along[bin] / pairs[bin] / along_square, 1e-12);
    EXPECT_NEAR(curve.across[bin], across[bin] / pairs[bin] / across_square, 1e-12);
  }
  EXPECT_NEAR(curve.near, near / near_pairs / (along_square + across_square), 1e-12);
}

// An annulus' inner wall hides what is behind it.
TEST(FlowSums, CountsOnlyPairsInSight) {
  const Region ring(kBox, SideWalls{Arena::kAnnulus, 18, 4});
  const std::vector<Vec2> places{{7, 10}, {13, 10}, {7, 12}};
  FlowSums sums(4, 8, 1);
  sums.accumulate(places, std::vector<Vec2>{{1, 0}, {-1, 0}, {1, 0}}, 0, ring);
  const FlowCurve curve = sums.reduce();
  EXPECT_NEAR(curve.c[1], 1, 1e-14);    // of the first and the third
  EXPECT_TRUE(std::isnan(curve.c[3]));  // the first two do not see each other
  EXPECT_TRUE(std::isnan(curve.near));
}

// Of more than 1024 rods some are the first of a pair, others the next time: the same mean.
TEST(FlowSums, TakesTurnsWithManyRods) {
  Draw draw(335);
  const std::vector<Vec2> places = lattice(40);
  std::vector<Vec2> velocities;
  for (const Vec2& place : places) velocities.push_back({std::sin(2 * kPi * place.y() / kBox), draw.normal()});
  FlowSums both(5, 5, 1), first(5, 5, 1), second(5, 5, 1);
  for (int i = 0; i < 2; ++i) both.accumulate(places, velocities, 0, kBox);
  second.start_at(1);
  first.accumulate(places, velocities, 0, kBox);
  second.accumulate(places, velocities, 0, kBox);
  EXPECT_NE(first.reduce().c, second.reduce().c);
  first.merge(second);
  for (std::size_t bin = 0; bin < 5; ++bin) EXPECT_NEAR(first.reduce().c[bin], both.reduce().c[bin], 1e-12);
}

TEST(FlowCorrelation, TakesDisplacementsFromSampleToSample) {
  FlowCorrelation flow(10, 10, 3);
  // Two rods side by side across the border of the box, which one of them crosses.
  const auto sample = [&](double time, Vec3 a, Vec3 b, double director) {
    const auto inside = [](Vec3 r) { return Vec3(r.x() - kBox * std::floor(r.x() / kBox), r.y(), r.z()); };
    flow.accumulate(time, std::vector<Vec3>{inside(a), inside(b)}, std::vector<Vec3>{a, b}, director, kBox);
  };
  sample(0, {19, 5, 0}, {20.5, 5, 0}, 0);
  EXPECT_TRUE(std::isnan(flow.sums().all().reduce().near));
  sample(0.5, {20, 5, 0}, {21.5, 5, 0}, kPi / 2);  // both by (2, 0)
  sample(1.0, {20, 6, 0}, {21.5, 4, 0}, 0);        // by (0, 2) and (0, -2), the director along y
  const FlowCurve curve = flow.sums().all().reduce();
  EXPECT_NEAR(curve.c[1], 0, 1e-12);
  EXPECT_NEAR(curve.along[1], 0, 1e-12);  // (4 - 4) / 2 over 4
  const FlowCurve later = flow.sums().after(0.5).reduce();
  EXPECT_NEAR(later.c[1], -1, 1e-12);
  EXPECT_NEAR(later.near, -1, 1e-12);
  EXPECT_THROW(flow.accumulate(2, std::vector<Vec3>(1), std::vector<Vec3>(1), 0, kBox), std::logic_error);
}

}  // namespace flow_correlation_test
}  // namespace shaken::analysis
