#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Mean velocity against tilt; all of shape (bins). A bin without samples has NaN velocities.
struct TiltMeans {
  std::vector<double> n_z;       ///< bin centres
  std::vector<double> v_along;   ///< along the rod's in-plane direction [mm/s]
  std::vector<double> v_across;  ///< across it, to the left [mm/s]
  std::vector<double> density;   ///< P(n_z), per unit n_z; its integral is the share of samples within +-n_z_max
};

/// The same with standard errors of the means [mm/s], NaN for a bin met in too few blocks (kFewestParts).
struct TiltCurve : TiltMeans {
  std::vector<double> v_along_sem;
  std::vector<double> v_across_sem;
};

/// Mean in-plane velocity of rods against the vertical component n_z of their director (Sharma & Soni 2024, figure on
/// v^n(n_z)): along n_xy / |n_xy|, and across it, along z x n_xy / |n_xy|. The sign of a director is a label that its
/// rod carries; nothing is symmetrised, so that v_along is odd in n_z is a measurement.
class TiltVelocity : public Summed<TiltVelocity> {
 public:
  /// `bins` equal bins over [-n_z_max, n_z_max].
  TiltVelocity(int bins, double n_z_max);

  /// Director (n_rods) and velocity of the centre (n_rods) [mm/s] at one instant. Rods exactly upright are left out.
  void accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities);
  TiltMeans means() const;

  /// The curve of all `blocks`, successive stretches of time, with errors by the jackknife over them. `empty` is one
  /// without samples, of the same bins.
  static TiltCurve reduce(const TiltVelocity& empty, const std::vector<TiltVelocity>& blocks);

  static constexpr const char* kName = "TiltVelocity";
  static auto fields(auto& self) {
    return listed(Setting{"range of n_z", self.n_z_max_}, self.outside_, self.counts_, self.along_, self.across_);
  }

 private:
  double n_z_max_;
  std::int64_t outside_ = 0;          // samples beyond +-n_z_max
  std::vector<std::int64_t> counts_;  // (bins)
  std::vector<double> along_;         // (bins) sum of v_along
  std::vector<double> across_;        // (bins) sum of v_across
};

/// In how many of `blocks` each bin was met, (bins).
std::vector<std::size_t> blocks_met(const std::vector<TiltVelocity>& blocks);

}  // namespace shaken::analysis
