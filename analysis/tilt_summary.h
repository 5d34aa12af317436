// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

#include "analysis/estimate.h"
#include "analysis/tilt.h"

namespace shaken::analysis {

/// v_along for n_z > 0, the two halves of the curve taken together: v(-n_z) = -v(n_z), since a director's sign is a
/// label. Mean of v(n_z) and -v(-n_z), each weighted with its number of samples.
struct FoldedTilt {
  std::vector<double> n_z;      ///< bin centres, rising
  EstimateCurve v_along;        ///< [mm/s]
  std::vector<double> density;  ///< P(|n_z|)
};
/// Bins without samples are left out, as is one centred at n_z = 0. A side without an error is left out if the other
/// has one.
FoldedTilt fold_tilt(const TiltCurve& curve);

/// What the curve of velocity against tilt comes down to. Bins count as independent.
struct TiltSummary {
  /// v_along where its magnitude is largest, over bins with n_z > 0 that differ from zero by more than three of their
  /// errors [mm/s], and its n_z; NaN without such a bin. Negative: rods move away from their raised end.
  Estimate v_largest;
  double n_z_largest = std::numeric_limits<double>::quiet_NaN();
  /// Beyond it: n_z at which v_along changes sign, between bins (linear); of several changes the one beyond which the
  /// other sign is most significant. NaN if there is none.
  double n_z_zero = std::numeric_limits<double>::quiet_NaN();
  /// Mean of v_along over the samples beyond the zero in units of its error, positive if its sign is the other one:
  /// what is below about 3 is no crossing. NaN without a zero.
  double zero_sigma = std::numeric_limits<double>::quiet_NaN();
};
TiltSummary summarize_tilt(const TiltCurve& curve);

}  // namespace shaken::analysis
