#include "base/core/sincos.h"

#include <gtest/gtest.h>

#include "tests/support/random_rods.h"

namespace shaken {
namespace {

TEST(SinCos, AgreesWithLongDouble) {
  test::Draw draw(1);
  double worst = 0;
  for (int k = 0; k < 200000; ++k) {
    const double x = draw.uniform(-1, 1) * std::pow(10.0, draw.uniform(-8, 4));
    const SinCos got = sincos(x);
    worst = std::max(worst, std::abs(got.sin - static_cast<double>(std::sin(static_cast<long double>(x)))));
    worst = std::max(worst, std::abs(got.cos - static_cast<double>(std::cos(static_cast<long double>(x)))));
  }
  EXPECT_LT(worst, 4e-16);
}

TEST(SinCos, IsExactAtZeroAndOddAndEven) {
  EXPECT_EQ(sincos(0.0).sin, 0.0);
  EXPECT_EQ(sincos(0.0).cos, 1.0);
  for (const double x : {1e-9, 0.3, 0.9, 2.0, 77.0}) {
    EXPECT_EQ(sincos(-x).sin, -sincos(x).sin);
    EXPECT_EQ(sincos(-x).cos, sincos(x).cos);
  }
}

}  // namespace
}  // namespace shaken
