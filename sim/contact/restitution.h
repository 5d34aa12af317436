#pragma once

#include <cmath>
#include <span>

#include "sim/system.h"

namespace shaken {

/// Fifth root of x >= 0, finite; the same bits on every machine (libm promises no last digit).
/// Numerics: x = 32^q m, m in [1/32, 1); four steps of Halley's method from a tangent at 1. Within 3 ulp of exact.
inline double fifth_root(double x) {
  if (x == 0) return 0;
  int exponent = 0;
  const double half_to_one = std::frexp(x, &exponent);
  const int q = exponent > 0 ? (exponent + 4) / 5 : exponent / 5;
  const double m = std::ldexp(half_to_one, exponent - 5 * q);
  double y = 0.8 + 0.2 * m;
  for (int step = 0; step < 4; ++step) {
    const double y5 = y * y * y * y * y;
    y *= (2.0 * y5 + 3.0 * m) / (3.0 * y5 + 2.0 * m);
  }
  return std::ldexp(y, q);
}

/// Restitution that falls with the speed v > 0 at which two bodies approach along the normal.
/// Model:  e(v) = 1 - (1 - e)(v / v_0)^(1/5) for v <= v_0, e (v / v_0)^(-1/4) above; e is that at v_0. Below v_0 the
///         bodies are viscoelastic (Hertz' contact with damping), above it they yield.
/// Source: McNamara & Falcon (2005), Phys. Rev. E 71, 031302, who take it for spheres of steel in a shaker; its
///         branches are the leading terms of Ramirez et al. (1999), Phys. Rev. E 60, 4465, and of Johnson (1985),
///         Contact Mechanics, section 11.5.
/// Units:  v, v_0 [mm/s]. The result is in (0, 1].
double falling_restitution(double restitution, double speed, double reference_speed);

/// Restitution of a contact whose bodies approach at `speed` [mm/s]; 1 where they do not approach.
inline double restitution_at(const ContactParameters& contact, double speed) {
  if (!contact.has_restitution_speed()) return contact.restitution;
  return falling_restitution(contact.restitution, speed, contact.restitution_speed);
}

/// The same of several contacts: speeds [mm/s] go in, restitutions come out in their places.
void restitution_at(const ContactParameters& contact, std::span<double> speeds);

}  // namespace shaken
