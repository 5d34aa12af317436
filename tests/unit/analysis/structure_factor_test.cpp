#include "analysis/structure_factor.h"

#include <gtest/gtest.h>

#include <complex>

#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/lattices.h"

namespace shaken::analysis {
namespace {

// Every wave vector of the box by the sum as it is written, for a director askew.
TEST(StructureFactor, IsTheSumAsWritten) {
  const Box box(9, 6.5);
  constexpr double kDirector = 0.4;
  constexpr int kWaves = 5;
  Draw draw(201);
  const std::vector<Vec3> places = random_places(draw, 40, box);
  StructureFactor structure(box, kWaves);
  structure.accumulate(places, std::vector<Vec3>(40, axis(kDirector, 0.2)));
  const StructureCurve curve = structure.reduce();
  ASSERT_EQ(curve.q.size(), 5U);
  for (int k = 1; k <= kWaves; ++k) {
    double sum[3] = {0, 0, 0}, terms[3] = {0, 0, 0};
    for (int m = -kWaves; m <= kWaves; ++m) {
      for (int n = -kWaves; n <= kWaves; ++n) {
        const Vec2 q(m, n * 9 / 6.5);
        if (std::abs(n) > 5 * 6.5 / 9 || std::lround(q.norm()) != k) continue;
        std::complex<double> amplitude = 0;
        for (const Vec3& place : places) {
          amplitude += std::polar(1.0, -2 * kPi / 9 * q.dot(place.head<2>()));
        }
        const double angle =
            std::abs(std::remainder(std::atan2(q.y(), q.x()) - kDirector, kPi));  // of the axis to the director
        const bool takes[3] = {true, angle <= kPi / 6, angle >= kPi / 3};
        for (int c = 0; c < 3; ++c) {
          sum[c] += takes[c] ? std::norm(amplitude) / 40 : 0;
          terms[c] += takes[c] ? 1 : 0;
        }
      }
    }
    const auto shell = static_cast<std::size_t>(k - 1);
    EXPECT_NEAR(curve.q[shell], 2 * kPi * k / 9, 1e-12);
    EXPECT_NEAR(curve.all[shell], sum[0] / terms[0], 1e-9) << k;
    EXPECT_NEAR(curve.along[shell], sum[1] / terms[1], 1e-9) << k;
    EXPECT_NEAR(curve.across[shell], sum[2] / terms[2], 1e-9) << k;
  }
}

// Rods that do not know of each other: 1 at every q. Of the first shell there are 4 terms in each of 200 samples, each
// exponentially distributed: 3.5 %, and less beyond.
TEST(StructureFactor, OfAGasIsOne) {
  Draw draw(202);
  StructureFactor structure(30, 8);
  for (int t = 0; t < 200; ++t) structure.accumulate(random_places(draw, 100, 30), random_axes(draw, 100));
  const StructureCurve curve = structure.reduce();
  for (const double s : curve.all) EXPECT_NEAR(s, 1.0, 0.14);
}

// A square lattice of 8 x 8: N on its reciprocal lattice, whose first points are the waves (8, 0) and (0, 8); nothing
// elsewhere. Of 8 waves to the box the cone about an axis has one such point.
TEST(StructureFactor, OfALatticeIsItsBraggPeaks) {
  StructureFactor structure(16, 9);
  structure.accumulate(square_lattice(8, 2.0), std::vector<Vec3>(64, axis(0)));
  const StructureCurve curve = structure.reduce();
  double vectors = 0, in_cone = 0;  // in the shell of 8 waves, of one sign
  for (int m = 0; m <= 9; ++m) {
    for (int n = m == 0 ? 1 : -9; n <= 9; ++n) {
      if (std::lround(std::hypot(m, n)) != 8) continue;
      vectors += 1;
      in_cone += std::abs(n) <= std::tan(kPi / 6) * m ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < curve.q.size(); ++k) {
    EXPECT_NEAR(curve.all[k], k == 7 ? 2 * 64 / vectors : 0, 1e-9) << k;
    EXPECT_NEAR(curve.along[k], k == 7 ? 64 / in_cone : 0, 1e-9) << k;
    EXPECT_NEAR(curve.across[k], k == 7 ? 64 / in_cone : 0, 1e-9) << k;
  }
}

TEST(StructureFactor, Merges) {
  Draw draw(203);
  StructureFactor straight(10, 4), first(10, 4), second(10, 4);
  EXPECT_TRUE(std::isnan(straight.reduce().all[0]));
  for (int t = 0; t < 4; ++t) {
    const std::vector<Vec3> places = random_places(draw, 20, 10), axes = random_axes(draw, 20);
    straight.accumulate(places, axes);
    (t < 2 ? first : second).accumulate(places, axes);
  }
  straight.accumulate({}, {});
  first.merge(second);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(first.reduce().all[k], straight.reduce().all[k], 1e-12);
  StructureFactor longer(11, 4), finer(10, 5);
  EXPECT_THROW(longer.merge(first), std::logic_error);
  EXPECT_THROW(finer.merge(first), std::logic_error);
}

}  // namespace
}  // namespace shaken::analysis
