#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <complex>

#include "analysis/geometry/wave_sums.h"
#include "analysis/structure_factor.h"
#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/lattices.h"

namespace shaken::analysis {
namespace {

// Every wave vector of the box by the sum as it is written, for directors askew; some vectors are just within the
// sectors of 30 degrees, and some just not.
class StructureOf : public testing::TestWithParam<double> {};

TEST_P(StructureOf, IsTheSumAsWritten) {
  const Box box(9, 6.5);
  constexpr int kWaves = 5;
  Draw draw(201);
  const std::vector<Vec3> places = random_places(draw, 40, box);
  StructureFactor structure(box, kWaves);
  EXPECT_TRUE(std::isnan(structure.reduce().all[0]));
  structure.accumulate(places, std::vector<Vec3>(40, axis(GetParam(), 0.2)));
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
            std::abs(std::remainder(std::atan2(q.y(), q.x()) - GetParam(), kPi));  // of the axis to the director
        const bool takes[3] = {true, angle <= kPi / 6, angle >= kPi / 3};
        for (int c = 0; c < 3; ++c) {
          sum[c] += takes[c] ? std::norm(amplitude) / 40 : 0;
          terms[c] += takes[c] ? 1 : 0;
        }
      }
    }
    const auto shell = static_cast<std::size_t>(k - 1);
    EXPECT_NEAR(curve.q[shell], 2 * kPi * k / 9, 1e-12);
    EXPECT_THAT(curve.all[shell], testing::NanSensitiveDoubleNear(sum[0] / terms[0], 1e-9)) << k;
    EXPECT_THAT(curve.along[shell], testing::NanSensitiveDoubleNear(sum[1] / terms[1], 1e-9)) << k;
    EXPECT_THAT(curve.across[shell], testing::NanSensitiveDoubleNear(sum[2] / terms[2], 1e-9)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Directors, StructureOf, testing::Range(0.1, 3.1, 0.25));

// Against the sum as it is written, for numbers of places and waves that fill no tile nor chunk.
TEST(WavePowers, AreTheSumsAsWritten) {
  const Box box(7, 11);
  Draw draw(101);
  for (const auto& [n, waves] : {std::pair(1, 1), {63, 4}, {130, 6}}) {
    std::vector<Vec2> places;
    std::vector<double> weights;
    for (int i = 0; i < n; ++i) {
      places.emplace_back(draw.uniform(-20, 20), draw.uniform(-20, 20));
      weights.push_back(draw.normal());
    }
    const WaveVectors vectors(box, waves);
    const std::vector<double> powers = wave_powers(places, weights, vectors);
    ASSERT_EQ(powers.size(), vectors.size());
    EXPECT_EQ(vectors.most_m, waves * 7 / 11);
    EXPECT_EQ(vectors.most_n, waves);
    for (int m = 0; m <= vectors.most_m; ++m) {
      for (int k = -waves; k <= waves; ++k) {
        std::complex<double> sum = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
          sum += weights[i] * std::polar(1.0, -2 * kPi * (m * places[i].x() / 7 + k * places[i].y() / 11));
        }
        EXPECT_NEAR(powers[vectors.index(m, k)], std::norm(sum), 1e-10 * n * n) << m << ' ' << k;
      }
    }
  }
}

TEST(WavePowers, OfNothingAreZero) {
  EXPECT_EQ(wave_powers({}, {}, {1.0, 2}), std::vector<double>(15, 0.0));
  EXPECT_THROW(WaveVectors(1.0, 0), std::logic_error);
  EXPECT_THROW(wave_powers(std::vector<Vec2>(1), {}, {1.0, 1}), std::logic_error);
}

}  // namespace
}  // namespace shaken::analysis
