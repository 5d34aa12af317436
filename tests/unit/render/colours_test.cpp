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
  const Vec3 along(std::cos(50 * kDegree), std::sin(50 * kDegree), 0);
  picture.director = {along, -along};
  picture.position.resize(2);
  const Colour layer = rod_colour(picture, 0, Colouring::kLayers), expected = layer_colour(10 * kDegree);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(layer[i], expected[i], 1e-9);
  EXPECT_EQ(rod_colour(picture, 0, Colouring::kWheel), wheel_colour(50 * kDegree));
  // Head and tail are the same.
  const Colour turned = rod_colour(picture, 1, Colouring::kLayers);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(turned[i], expected[i], 1e-9);
}

TEST(RodColour, RodsOfOtherKindsHaveTheirOwnWhateverTheirAngle) {
  RodPicture picture;
  picture.added.resize(2);
  picture.species_of_rod = {1, 1, 2};
  picture.director = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)};
  picture.position.resize(3);
  for (const Colouring colouring : {Colouring::kLayers, Colouring::kWheel}) {
    EXPECT_EQ(rod_colour(picture, 0, colouring), rod_colour(picture, 1, colouring));
    // Told apart by lightness alone, so by anybody: from each other.
    const auto lightness = [](const Colour& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
    EXPECT_GT(lightness(rod_colour(picture, 0, colouring)), 1.4 * lightness(rod_colour(picture, 2, colouring)));
  }
  // Grey beside the colours of angles.
  const auto vividness = [](const Colour& c) {
    return *std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end());
  };
  for (const std::size_t kind : {1, 2}) EXPECT_LT(2 * vividness(species_colour(kind)), vividness(layer_colour(0.5)));
}

}  // namespace
}  // namespace shaken::render
