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
    EXPECT_EQ(layer_colour(sign * 15 * kDegree), layer_colour(sign * 45 * kDegree));
  }
}

TEST(LayerColour, IsTheSameGreyOnBothSidesOfTheRightAngle) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(layer_colour(kPi / 2)[i], layer_colour(-kPi / 2)[i], 1e-12);
  EXPECT_LT(spread(layer_colour(kPi / 2)), 0.08);
  EXPECT_LT(spread(layer_colour(80 * kDegree)), 0.5 * spread(layer_colour(45 * kDegree)));
}

TEST(WheelColour, HasPeriodPi) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const Colour here = wheel_colour(degrees * kDegree), there = wheel_colour((degrees - 180) * kDegree);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(here[i], there[i], 1e-9);
  }
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(WheelColour, EqualTurnsAreEqualStepsInOklab) {
  // Clipping at the border of sRGB would show here as an uneven step.
  double least = 1e9, most = 0;
  for (int degrees = 0; degrees < 180; degrees += 5) {
    const double step = distance(oklab(wheel_colour(degrees * kDegree)), oklab(wheel_colour((degrees + 5) * kDegree)));
    least = std::min(least, step);
    most = std::max(most, step);
  }
  EXPECT_LT(most / least, 1.1);
}

/// What somebody without the cones for red, or for green, sees: Machado, Oliveira & Fernandes (2009), severity 1.
Colour seen_by(bool protanope, const Colour& colour) {
  constexpr double kProtan[3][3] = {
      {0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}};
  constexpr double kDeutan[3][3] = {
      {0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}};
  const auto& matrix = protanope ? kProtan : kDeutan;
  Colour linear, seen;
  for (std::size_t i = 0; i < 3; ++i)
    linear[i] = colour[i] <= 0.04045 ? colour[i] / 12.92 : std::pow((colour[i] + 0.055) / 1.055, 2.4);
  for (std::size_t i = 0; i < 3; ++i) {
    const double x =
        std::clamp(matrix[i][0] * linear[0] + matrix[i][1] * linear[1] + matrix[i][2] * linear[2], 0.0, 1.0);
    seen[i] = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  }
  return seen;
}

TEST(WheelColour, AxesThirtyDegreesApartLookDifferentToTheColourBlindToo) {
  // A circle of one lightness comes down to 0.01 here: its red and its green fall together.
  constexpr double kVisible = 0.06;
  for (const bool protanope : {false, true}) {
    for (int a = 0; a < 180; a += 5) {
      for (int b = 0; b < a; b += 5) {
        if (std::min(a - b, 180 - a + b) < 30) continue;
        EXPECT_GT(distance(oklab(seen_by(protanope, wheel_colour(a * kDegree))),
                           oklab(seen_by(protanope, wheel_colour(b * kDegree)))),
                  kVisible)
            << a << ' ' << b;
      }
    }
  }
}

TEST(HeadingColour, TellsHeadFromTail) {
  EXPECT_GT(distance(oklab(heading_colour(0.3)), oklab(heading_colour(0.3 + kPi))), 0.2);
}

TEST(SequentialColour, GetsLighterAllTheWay) {
  for (int i = 1; i <= 50; ++i) {
    EXPECT_GT(oklab(sequential_colour(i / 50.0))[0], oklab(sequential_colour((i - 1) / 50.0))[0]) << i;
  }
  EXPECT_EQ(sequential_colour(-3), sequential_colour(0));
  EXPECT_EQ(sequential_colour(3), sequential_colour(1));
}

TEST(DivergingColour, TellsSignsFromEachOtherAndFromNothing) {
  for (const bool protanope : {false, true}) {
    const auto minus = oklab(seen_by(protanope, diverging_colour(-1))),
               plus = oklab(seen_by(protanope, diverging_colour(1))),
               middle = oklab(seen_by(protanope, diverging_colour(0)));
    EXPECT_GT(distance(minus, plus), 0.15);
    EXPECT_GT(distance(minus, middle), 0.2);
    EXPECT_GT(distance(plus, middle), 0.2);
  }
}

}  // namespace
}  // namespace shaken::render
