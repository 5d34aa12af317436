#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/bounded_series.h"
#include "analysis/errors/spread.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Polar order in the plane of the plates: how far the heads of rods point the same way.
struct PolarOrder {
  double order = 0;      ///< P in [0, 1]; N independent random rods have <P^2> = 1 / N
  double direction = 0;  ///< angle of the mean to x, in [-pi, pi] [rad]
};

/// P = |mean u| over the unit vectors u in the plane along `directors` (n_rods; any length but zero), each from tail to
/// head, and the angle of that mean. A rod exactly upright has no u: it is left out. Without any rod that has one,
/// {0, 0}.
PolarOrder polar_order(std::span<const Vec3> directors);

/// P(t) and the direction of the mean, in bounded memory: of a long run a point is the mean over several successive
/// samples, that of the direction being the angle of the mean of P u (see BoundedSeries).
class PolarSeries : public Saved<PolarSeries> {
 public:
  /// Takes a sample at `time` [s], later than all before.
  void accumulate(double time, const PolarOrder& sample);

  const std::vector<double>& times() const { return series_.times(); }     ///< (n) [s]
  const std::vector<double>& orders() const { return series_.column(0); }  ///< (n)
  std::vector<double> directions() const;                                  ///< (n) [rad], in [-pi, pi]

  static auto fields(auto& self) { return listed(self.series_); }

 private:
  BoundedSeries<3> series_;  // P, P cos, P sin
};

/// Polar order, and the motion of rods in the plane by their own directions u. NaN without samples.
struct PolarNumbers {
  double order = 0;       ///< mean of P
  double variance = 0;    ///< of P; times the number of rods it is the susceptibility
  double forward = 0;     ///< <v . u>: negative where tails swim first [mm/s]
  double along_rms = 0;   ///< sqrt(<(v . u)^2>) [mm/s]
  double across_rms = 0;  ///< that across u [mm/s]
  /// Mean over instants of |<v>| / <|v|>: 1 where all fly the same way, of order 1 / sqrt(N) where each flies its own
  /// (Vicsek et al., Phys. Rev. Lett. 75, 1226 (1995)).
  double velocity_polarity = 0;
};

/// Sums of these over the samples of a run.
class PolarStatistics : public Summed<PolarStatistics> {
 public:
  /// The rods of one instant: their directors and velocities [mm/s], as many of each, and their polar_order().
  void accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities, const PolarOrder& order);
  PolarNumbers reduce() const;

  static constexpr const char* kName = "PolarStatistics";
  static auto fields(auto& self) {
    return listed(self.spread_, self.rods_, self.forward_, self.along_, self.across_, self.moving_, self.flight_);
  }

 private:
  Spread spread_;          // of P
  std::int64_t rods_ = 0;  // of all samples, that have a direction in the plane
  double forward_ = 0;     // sum of v . u
  double along_ = 0;       // sum of (v . u)^2
  double across_ = 0;
  std::int64_t moving_ = 0;  // samples in which any rod moves
  double flight_ = 0;        // sum of |<v>| / <|v|> over these
};

}  // namespace shaken::analysis
