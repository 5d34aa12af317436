#include "analysis/geometry/wave_sums.h"

#include <gtest/gtest.h>

#include <complex>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

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
