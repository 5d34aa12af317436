// SPDX-License-Identifier: MIT
#include "render/colours.h"

#include <algorithm>
#include <cmath>

#include "analysis/periodic.h"

namespace shaken::render {
namespace {

/// Lightness, and the two opponent axes, of the OKLab space (Ottosson 2020).
struct Oklab {
  double lightness, a, b;
};

Oklab polar(double lightness, double chroma, double hue_degrees) {
  const double hue = hue_degrees * kPi / 180;
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

double encode_srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

Colour to_srgb(const Oklab& c) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b);
  const double m = cube(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b);
  const double s = cube(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b);
  return {encode_srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encode_srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encode_srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Oklab mix(const Oklab& x, const Oklab& y, double t) {
  return {x.lightness + t * (y.lightness - x.lightness), x.a + t * (y.a - x.a), x.b + t * (y.b - x.b)};
}

constexpr double kFullAngle = 15 * kPi / 180;  // the angle of the fully grown colour
const Oklab kNeutral = polar(0.93, 0.012, 60);
const Oklab kRed = polar(0.60, 0.235, 29);
const Oklab kMagenta = polar(0.57, 0.25, 334);
const Oklab kTeal = polar(0.68, 0.055, 205);
const Oklab kSlate = polar(0.47, 0.025, 255);

}  // namespace

Colour layer_colour(double theta) {
  const double t = std::min(std::abs(theta) / kFullAngle, 1.0);
  return to_srgb(mix(kNeutral, theta > 0 ? kRed : kMagenta, t));
}

Colour wheel_colour(double angle) { return to_srgb(polar(0.74, 0.126, 29 + angle * 360 / kPi)); }

Colour species_colour(std::size_t species) { return to_srgb(species == 1 ? kTeal : kSlate); }

Colour rod_colour(const RodPicture& picture, std::size_t i, Colouring colouring) {
  if (const std::size_t species = picture.species_of(i); species != 0) return species_colour(species);
  const Vec3& director = picture.director[i];
  const double angle = std::atan2(director.y(), director.x());
  return colouring == Colouring::kLayers ? layer_colour(analysis::fold_half_turn(angle - picture.director_angle))
                                         : wheel_colour(angle);
}

Palette palette(Theme theme) {
  if (theme == Theme::kDark) {
    return {{0.071, 0.078, 0.094}, {0.11, 0.118, 0.137}, {0.92, 0.925, 0.935}, {0.56, 0.58, 0.62}, {0.21, 0.22, 0.245}};
  }
  return {{1, 1, 1}, {0.965, 0.96, 0.95}, {0.11, 0.12, 0.14}, {0.45, 0.46, 0.49}, {0.84, 0.845, 0.855}};
}

}  // namespace shaken::render
