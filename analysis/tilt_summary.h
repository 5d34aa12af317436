#pragma once

#include <limits>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/tilt.h"

namespace shaken::analysis {

/// v_along for n_z > 0, the two halves of the curve taken together: v(-n_z) = -v(n_z), since a director's sign is a
/// label. Mean of v(n_z) and -v(-n_z), each weighted with its number of samples. Bins without samples are left out, as
/// is one centred at n_z = 0.
struct FoldedTilt {
  std::vector<double> n_z;        ///< bin centres, rising
  std::vector<Estimate> v_along;  ///< [mm/s]
  std::vector<double> density;    ///< P(|n_z|)
};

/// What the curve of velocity against tilt comes down to.
struct TiltSummary {
  FoldedTilt folded;
  /// v_along where its magnitude is largest, over bins with n_z > 0 that have at least 1 % of the samples and differ
  /// from zero by more than three of their errors [mm/s]; NaN without such a bin. Negative: rods move away from their
  /// raised end. The largest of several alike is one that chance made larger, by about its error.
  Estimate v_largest;
  /// Its n_z: the bin. The error is the spread of all places from the first to the last bin whose velocity lies below
  /// by less than two errors of the difference, each of them as wide as the bin: that range over sqrt(12).
  Estimate n_z_largest;
  /// Beyond it: n_z at which v_along changes sign, between bins (linear); of several changes the one beyond which the
  /// other sign is most significant. NaN if there is none.
  Estimate n_z_zero;
  /// Mean of v_along over the samples beyond the zero in units of its error, positive if its sign is the other one:
  /// what is below about 3 is no crossing. NaN without a zero.
  double zero_sigma = std::numeric_limits<double>::quiet_NaN();
};

/// The summary of all `blocks`, successive stretches of time, with errors by the jackknife over them, given which bins
/// are chosen. `empty` is one without samples, of the same bins.
TiltSummary summarize_tilt(const TiltVelocity& empty, const std::vector<TiltVelocity>& blocks);

}  // namespace shaken::analysis
