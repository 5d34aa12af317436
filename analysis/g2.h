#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// G2(r) and g(r); all of shape (bins).
struct OrientationCurve {
  std::vector<double> r;   ///< bin centres [mm]
  std::vector<double> g2;  ///< in [-1, 1]; NaN where no pair was met
  std::vector<double> g;   ///< pairs met over pairs expected of as many rods of a gas; NaN without such
};

/// G2(r) = <cos 2 (theta_i - theta_j)> over pairs of rods at in-plane distance r below r_max: that to the nearest image
/// of a periodic box, the plain one within walls, where pairs count whose straight line stays in the region (an
/// annulus' inner wall hides what is behind it). The same pairs give the distribution g(r): their number over that of a
/// gas of as many rods, references x rho x what of the ring about each reference is in its sight
/// (Region::area_in_sight, exact). rho is n - 1 over the region's area, for a rod makes no pair with itself: g of rods
/// that do not know of each other is 1, however few they are. One sample costs at most 1024 n_rods pairs: of more than
/// 1024 rods, every k-th is taken as i, another set each time, against all rods as j. Rods exactly upright are left
/// out.
class OrientationCorrelation : public Summed<OrientationCorrelation> {
 public:
  /// `bins` equal bins over [0, r_max) [mm].
  OrientationCorrelation(int bins, double r_max);

  /// Centres (n_rods) [mm] and directors (n_rods); the side of a periodic box is at least 2 r_max [mm].
  void accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors, const Region& region);
  /// Samples that others have taken before: whose turn it is as the first of a pair depends on it.
  void start_at(std::int64_t samples) { calls_ = samples; }
  OrientationCurve reduce() const;

  static constexpr const char* kName = "OrientationCorrelation of n (n - 1) pairs";
  static auto fields(auto& self) {
    return listed(Setting{"range", self.r_max_}, Largest{self.calls_}, self.pairs_, self.sums_, self.expected_);
  }

 private:
  double r_max_;
  std::int64_t calls_ = 0;           // samples so far, those before start_at included
  std::vector<std::int64_t> pairs_;  // (bins)
  std::vector<double> sums_;         // (bins) of cos 2 (theta_i - theta_j)
  std::vector<double> expected_;     // (bins) pairs of a gas
};

}  // namespace shaken::analysis
