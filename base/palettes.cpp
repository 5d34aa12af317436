#include "base/palettes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace shaken {
namespace {

constexpr double kPi = std::numbers::pi;

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
constexpr double kFadeAngle = 45 * kPi / 180;  // where it begins to go again
const Oklab kNeutral = polar(0.93, 0.012, 60);
const Oklab kAcross = polar(0.62, 0.012, 260);
const Oklab kRed = polar(0.60, 0.235, 29);
const Oklab kMagenta = polar(0.57, 0.25, 334);
const Oklab kOrange = polar(0.68, 0.165, 56);
const Oklab kBlue = polar(0.58, 0.16, 256);
const Oklab kSlate = polar(0.43, 0.03, 255);
const Oklab kCoal = polar(0.30, 0.02, 255);

/// A circle in OKLab in a plane that is tilted about the blue-yellow axis. The radius and the tilt are as large as sRGB
/// allows; red lies where it did in the flat circle.
Colour on_circle(double turn) {
  constexpr double kMiddle = 0.68, kRadius = 0.14, kTilt = 55 * kPi / 180;
  const double hue = 29 * kPi / 180 + turn;
  const double redness = kRadius * std::cos(hue);
  return to_srgb({kMiddle - redness * std::sin(kTilt), redness * std::cos(kTilt), kRadius * std::sin(hue)});
}

}  // namespace

Colour layer_colour(double theta, Palette palette) {
  const bool is_paper = palette == Palette::kPaper;
  const Oklab& left = is_paper ? kRed : kOrange;
  const Oklab& right = is_paper ? kMagenta : kBlue;
  const double size = std::abs(theta);
  const Oklab full = mix(kNeutral, theta > 0 ? left : right, std::min(size / kFullAngle, 1.0));
  if (size <= kFadeAngle) return to_srgb(full);
  return to_srgb(mix(full, kAcross, std::min((size - kFadeAngle) / (kPi / 2 - kFadeAngle), 1.0)));
}

Colour wheel_colour(double angle) { return on_circle(2 * angle); }

Colour heading_colour(double direction) { return on_circle(direction); }

Colour sequential_colour(double x) {
  constexpr Colour kViridis[] = {
      {0.267004, 0.004874, 0.329415}, {0.282623, 0.140926, 0.457517}, {0.253935, 0.265254, 0.529983},
      {0.206756, 0.371758, 0.553117}, {0.163625, 0.471133, 0.558148}, {0.127568, 0.566949, 0.550556},
      {0.134692, 0.658636, 0.517649}, {0.266941, 0.748751, 0.440573}, {0.477504, 0.821444, 0.318195},
      {0.741388, 0.873449, 0.149561}, {0.993248, 0.906157, 0.143936}};
  constexpr int kPieces = static_cast<int>(std::size(kViridis)) - 1;
  const double at = std::clamp(x, 0.0, 1.0) * kPieces;
  const int piece = std::min(static_cast<int>(at), kPieces - 1);
  return blend(kViridis[piece], kViridis[piece + 1], at - piece);
}

Colour diverging_colour(double x) {
  return to_srgb(mix(kNeutral, x > 0 ? kOrange : kBlue, std::min(std::abs(x), 1.0)));
}

Colour species_colour(std::size_t species) { return to_srgb(species == 1 ? kSlate : kCoal); }

Colour name_colour(std::size_t index) {
  constexpr Colour kOkabeIto[] = {{0.902, 0.624, 0.0}, {0.0, 0.447, 0.698}, {0.6, 0.62, 0.64}};
  return kOkabeIto[index % std::size(kOkabeIto)];
}

Colour number_colour(std::size_t number) {
  // Successive numbers lie a golden angle apart in hue, so neighbours in the list never look alike.
  constexpr double kGolden = 137.50776405003785;
  const auto n = static_cast<double>(number);
  return to_srgb(polar(0.64 + 0.05 * static_cast<double>(number % 4), 0.11, std::fmod(n * kGolden, 360.0)));
}

Colour no_value_colour() { return to_srgb(polar(0.72, 0.006, 250)); }

Colour no_order_colour(bool is_page_dark) {
  return to_srgb(is_page_dark ? polar(0.50, 0.09, 265) : polar(0.55, 0.07, 255));
}

Colour blend(const Colour& x, const Colour& y, double t) {
  return {x[0] + t * (y[0] - x[0]), x[1] + t * (y[1] - x[1]), x[2] + t * (y[2] - x[2])};
}

}  // namespace shaken
