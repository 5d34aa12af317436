#include "base/palettes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shaken {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

double spread(const Colour& c) { return *std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end()); }

/// Of sRGB (IEC 61966-2-1).
Colour linear(Colour c) {
  for (double& part : c) part = part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
  return c;
}

/// OKLab from sRGB: the published forward matrices (Ottosson 2020), independent of the inverse ones under test.
std::array<double, 3> oklab(const Colour& c) {
  const auto [r, g, b] = linear(c);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(LayerColour, OfThePaperIsNeutralAlongTheDirectorRedToTheLeftMagentaToTheRight) {
  EXPECT_LT(spread(layer_colour(0, Palette::kPaper)), 0.08);
  const Colour left = layer_colour(15 * kDegree, Palette::kPaper), right = layer_colour(-15 * kDegree, Palette::kPaper);
  EXPECT_GT(left[0], 2.5 * left[1]);
  EXPECT_GT(left[0], 2.5 * left[2]);
  EXPECT_GT(right[0], 2.5 * right[1]);
  EXPECT_GT(right[2], 2.5 * right[1]);
}

TEST(LayerColour, GrowsWithTheAngleUpToFifteenDegrees) {
  for (const int sign : {-1, 1}) {
    for (int degrees = 1; degrees <= 15; ++degrees) {
      const auto grown = [&](int at) {
        return distance(oklab(layer_colour(0)), oklab(layer_colour(sign * at * kDegree)));
      };
      EXPECT_GT(grown(degrees), grown(degrees - 1));
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

using Matrix = std::array<std::array<double, 3>, 3>;

/// What is seen with all cones, without those for red, and without those for green: Machado, Oliveira & Fernandes
/// (2009), severity 1, of linear RGB.
constexpr std::array<Matrix, 3> kEyes{
    {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}}};

/// CIELAB (CIE 1976, white D65) of what somebody with this matrix of linear RGB sees.
std::array<double, 3> lab_seen(const Colour& colour, const Matrix& matrix) {
  const auto [red, green, blue] = linear(colour);
  Colour seen;
  for (std::size_t i = 0; i < 3; ++i)
    seen[i] = std::clamp(matrix[i][0] * red + matrix[i][1] * green + matrix[i][2] * blue, 0.0, 1.0);
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const auto [r, g, b] = seen;
  const double x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047),
               y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b),
               z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/// The least distance in CIELAB between two colours for anybody: with all cones, without those for red, for green.
double told_apart(const Colour& a, const Colour& b) {
  double least = 1e9;
  for (const Matrix& matrix : kEyes) least = std::min(least, distance(lab_seen(a, matrix), lab_seen(b, matrix)));
  return least;
}

TEST(WheelColour, NeighboursAndOppositesAreToldApartByTheColourBlindToo) {
  // Of a circle of one lightness, axes at right angles come down to 2.
  for (int a = 0; a < 180; a += 5) {
    const auto to = [&](int turn) { return told_apart(wheel_colour(a * kDegree), wheel_colour((a + turn) * kDegree)); };
    EXPECT_GT(to(15), 6) << a;
    EXPECT_GT(to(90), 24) << a;
    for (int turn = 30; turn <= 90; turn += 5) EXPECT_GT(to(turn), 12) << a << ' ' << turn;
  }
}

TEST(LayerColour, SidesAreToldApartByTheColourBlindToo) {
  for (const Palette palette : {Palette::kSafe, Palette::kPaper}) {
    EXPECT_GT(told_apart(layer_colour(0.3, palette), layer_colour(-0.3, palette)), 60);
    for (const double side : {0.3, -0.3}) {
      EXPECT_GT(told_apart(layer_colour(side, palette), layer_colour(0, palette)), 40);
    }
  }
  EXPECT_GT(told_apart(layer_colour(0.3), layer_colour(-0.3)), 90) << "the safe ones by lightness and hue";
}

TEST(SpeciesColour, IsNoColourOfAnAngle) {
  for (const std::size_t species : {1, 2}) {
    for (int degrees = -90; degrees <= 90; degrees += 3) {
      const double angle = degrees * kDegree;
      EXPECT_GT(told_apart(species_colour(species), wheel_colour(angle)), 10) << species << ' ' << degrees;
      for (const Palette palette : {Palette::kSafe, Palette::kPaper}) {
        EXPECT_GT(told_apart(species_colour(species), layer_colour(angle, palette)), 15) << species << ' ' << degrees;
      }
    }
  }
  EXPECT_GT(told_apart(species_colour(1), species_colour(2)), 12);
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

TEST(Colours, AreThoseAskedForInOklab) {
  const auto off = [](const Colour& colour, double lightness, double chroma, double hue) {
    return distance(oklab(colour), {lightness, chroma * std::cos(hue * kDegree), chroma * std::sin(hue * kDegree)});
  };
  EXPECT_LT(off(diverging_colour(1), 0.68, 0.165, 56), 1e-5) << "whose blue is nearly none";
  EXPECT_LT(off(no_order_colour(true), 0.50, 0.09, 265), 1e-5);
  EXPECT_LT(off(no_order_colour(false), 0.55, 0.07, 255), 1e-5);
}

TEST(DivergingColour, TellsSignsFromEachOtherAndFromNothing) {
  EXPECT_GT(told_apart(diverging_colour(-1), diverging_colour(1)), 90);
  for (const double sign : {-1.0, 1.0}) EXPECT_GT(told_apart(diverging_colour(sign), diverging_colour(0)), 30);
}

}  // namespace
}  // namespace shaken
