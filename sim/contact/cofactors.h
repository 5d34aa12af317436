#pragma once

namespace shaken {

/// Solves K x = b by cofactors, for a symmetric positive definite K with the rows (a p q), (p d r), (q r f): one system
/// or several at a time (lanes/double_lanes.h).
template <class Real>
struct Cofactors {
  Real c00, c01, c02, c11, c12, c22, inverse_det;

  [[gnu::always_inline]] inline Cofactors(const Real& a, const Real& d, const Real& f, const Real& p, const Real& q,
                                          const Real& r)
      : c00(d * f - r * r),
        c01(q * r - p * f),
        c02(p * r - q * d),
        c11(a * f - q * q),
        c12(p * q - a * r),
        c22(a * d - p * p),
        inverse_det(1.0 / (a * c00 + p * c01 + q * c02)) {}

  template <class Vector>
  [[gnu::always_inline]] inline Vector solve(const Real& x, const Real& y, const Real& z) const {
    return {inverse_det * (c00 * x + c01 * y + c02 * z), inverse_det * (c01 * x + c11 * y + c12 * z),
            inverse_det * (c02 * x + c12 * y + c22 * z)};
  }
};

}  // namespace shaken
