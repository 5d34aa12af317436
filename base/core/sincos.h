#pragma once

#include <cmath>

namespace shaken {

template <class Real>
struct SinCosOf {
  Real sin;
  Real cos;
};
using SinCos = SinCosOf<double>;

/// Up to here the series below holds [rad].
inline constexpr double kLargestSmallAngle = 0.7853981633974483;

/// Taylor series on |x| <= pi/4; the first term left out is below 3e-18. Of one angle or of several at a time
/// (sim/lanes/double_lanes.h).
template <class Real>
[[gnu::always_inline]] inline SinCosOf<Real> sincos_of_small(const Real& x) {
  const Real y = x * x;
  Real s = y * (1.0 / 355687428096000.0) - 1.0 / 1307674368000.0;
  s = s * y + 1.0 / 6227020800.0;
  s = s * y - 1.0 / 39916800.0;
  s = s * y + 1.0 / 362880.0;
  s = s * y - 1.0 / 5040.0;
  s = s * y + 1.0 / 120.0;
  s = s * y - 1.0 / 6.0;
  Real c = y * (1.0 / 20922789888000.0) - 1.0 / 87178291200.0;
  c = c * y + 1.0 / 479001600.0;
  c = c * y - 1.0 / 3628800.0;
  c = c * y + 1.0 / 40320.0;
  c = c * y - 1.0 / 720.0;
  c = c * y + 1.0 / 24.0;
  c = c * y - 0.5;
  return {x + x * y * s, 1.0 + y * c};
}

/// Sine and cosine of x [rad], the same bits on every machine and at every vector width (libm promises neither).
/// Numerics: within 2 ulp of exact for |x| < 1e5; the reduction by pi/2 in three parts loses digits beyond.
inline SinCos sincos(double x) {
  if (std::abs(x) <= kLargestSmallAngle) return sincos_of_small(x);
  // pi/2 = p1 + p2 + p3; p1 and p2 have trailing zeros so that q * p1 and q * p2 are exact
  constexpr double p1 = 0x1.921fb544p+0;
  constexpr double p2 = 0x1.0b4611a6p-34;
  constexpr double p3 = 0x1.3198a2e037073p-69;
  const double q = std::nearbyint(x * 0.6366197723675814);
  const SinCos r = sincos_of_small(((x - q * p1) - q * p2) - q * p3);
  switch (static_cast<long long>(q) & 3) {
    case 0:
      return r;
    case 1:
      return {r.cos, -r.sin};
    case 2:
      return {-r.sin, -r.cos};
    default:
      return {-r.cos, r.sin};
  }
}

}  // namespace shaken
