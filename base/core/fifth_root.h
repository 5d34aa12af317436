#pragma once

#include <cmath>

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

}  // namespace shaken
