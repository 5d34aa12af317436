// SPDX-License-Identifier: MIT
#include "render/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace shaken::render {
namespace {

constexpr double kDegree = kPi / 180;

double spread(const Colour& c) { return *std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end()); }

/// OKLab from sRGB: the published forward matrices (Ottosson 2020), independent of the inverse ones under test.
std::array<double, 3> oklab(const Colour& c) {
  std::array<double, 3> linear;
  for (std::size_t i = 0; i < 3; ++i)
    linear[i] = c[i] <= 0.04045 ? c[i] / 12.92 : std::pow((c[i] + 0.055) / 1.055, 2.4);
  const auto [r, g, b] = linear;
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(LayerColour, IsNeutralAlongTheDirectorRedToTheLeftMagentaToTheRight) {
  EXPECT_LT(spread(layer_colour(0)), 0.08);
  const Colour left = layer_colour(15 * kDegree), right = layer_colour(-15 * kDegree);
  EXPECT_GT(left[0], 2.5 * left[1]);
  EXPECT_GT(left[0], 2.5 * left[2]);
  EXPECT_GT(right[0], 2.5 * right[1]);
  EXPECT_GT(right[2], 2.5 * right[1]);
}

TEST(LayerColour, GrowsWithTheAngleUpToFifteenDegrees) {
  for (const int sign : {-1, 1}) {
    for (int degrees = 1; degrees <= 15; ++degrees) {
      EXPECT_GT(spread(layer_colour(sign * degrees * kDegree)), spread(layer_colour(sign * (degrees - 1) * kDegree)));
    }
    EXPECT_EQ(layer_colour(sign * 15 * kDegree), layer_colour(sign * 80 * kDegree));
  }
}

TEST(WheelColour, HasPeriodPi) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const Colour here = wheel_colour(degrees * kDegree), there = wheel_colour((degrees - 180) * kDegree);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(here[i], there[i], 1e-9);
  }
}

TEST(WheelColour, EqualTurnsAreEqualStepsInOklabAtOneLightness) {
  // Clipping at the border of sRGB would show here as an uneven step.
  double least = 1e9, most = 0;
  for (int degrees = 0; degrees < 180; degrees += 5) {
    const auto a = oklab(wheel_colour(degrees * kDegree)), b = oklab(wheel_colour((degrees + 5) * kDegree));
    const double step = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    least = std::min(least, step);
    most = std::max(most, step);
    EXPECT_NEAR(a[0], 0.74, 0.01) << degrees;
  }
  EXPECT_LT(most / least, 1.1);
}

TEST(RodColour, LayersFollowTheDirectorTheWheelTheBox) {
  RodPicture picture;
  picture.director_angle = 40 * kDegree;
  const auto along = [](double degrees) { return Vec3(std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0); };
  const Colour layer = rod_colour(picture, along(50), Colouring::kLayers), expected = layer_colour(10 * kDegree);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(layer[i], expected[i], 1e-9);
  EXPECT_EQ(rod_colour(picture, along(50), Colouring::kWheel), wheel_colour(50 * kDegree));
  // Head and tail are the same.
  const Colour turned = rod_colour(picture, -along(50), Colouring::kLayers);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(turned[i], expected[i], 1e-9);
}

}  // namespace
}  // namespace shaken::render
