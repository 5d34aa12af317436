#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/estimate_curve.h"
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

/// The largest |n_z| of a rod that touches both plates, `gap` apart, without overlap, at most 1. Its end beads, of
/// `end_radius`, are `half_length` from its centre [mm].
double largest_tilt(double half_length, double end_radius, double gap);

/// How many rods changed sides, in how much time of theirs.
struct SwitchSums : Summed<SwitchSums> {
  double switches = 0;
  double lived = 0;  ///< by all rods whose side is known, together [s]

  void accumulate(const SwitchSums& other) { merge(other); }
  static auto fields(auto& self) { return listed(self.switches, self.lived); }
};

/// How long rods stay tilted to one side. A rod is up, head higher than tail, from when its n_z rises beyond
/// `threshold` until it falls below -`threshold`, and down from then on: what turns back in between has not switched
/// (a comparator with hysteresis: Schmitt, J. Sci. Instrum. 15, 24 (1938)). The switching time is the time that all
/// rods lived, each from when its side is first known, over the number of their switches: the mean time from one switch
/// to the next, whatever the run's ends cut off. Switches there and back between two samples are missed, so it is at
/// least about the interval. Memory: 8 bytes a rod, and 64 blocks.
class TiltSwitches : public Saved<TiltSwitches> {
 public:
  explicit TiltSwitches(double threshold);

  /// Directors (n_rods) at `time` [s], later than all before; n_rods is the same in every call.
  void accumulate(double time, std::span<const Vec3> directors);
  const Blocked<SwitchSums>& sums() const { return blocks_; }
  /// Mean time from switch to switch [s]; NaN where no rod has switched.
  static double switching_time(const SwitchSums& sums);

  static constexpr const char* kName = "TiltSwitches";
  static auto fields(auto& self) {
    return listed(Setting{"threshold", self.threshold_}, self.last_time_, Growing{self.sides_}, self.blocks_);
  }

 private:
  double threshold_;
  double last_time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::int64_t> sides_;  // (n_rods) +1 up, -1 down, 0 not yet known
  Blocked<SwitchSums> blocks_{SwitchSums{}};
};

}  // namespace shaken::analysis
