#pragma once

#include <cmath>

namespace shaken {

/// Natural logarithm of x, normal and positive; the same bits on every machine (libm promises no last digit).
/// Numerics: x = 2^k m, ln m = 2 artanh((m - 1) / (m + 1)) by its series for m in [sqrt(1/2), sqrt(2)]; the first term
/// left out is below 1e-18. Within 2 ulp of exact.
inline double natural_log(double x) {
  constexpr double kLn2High = 0x1.62e42fefa38p-1;  // trailing zeros: exact times a whole number
  constexpr double kLn2Low = 0x1.ef35793c7673p-45;
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.7071067811865476) {
    m *= 2.0;
    --exponent;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double y = s * s;
  double series = 1.0 / 23.0;
  for (int odd = 21; odd >= 3; odd -= 2) series = series * y + 1.0 / odd;
  return exponent * kLn2High + (2.0 * s + (2.0 * s * y * series + exponent * kLn2Low));
}

}  // namespace shaken
