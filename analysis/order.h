#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/errors/bounded_series.h"
#include "analysis/errors/saved.h"
#include "analysis/errors/spread.h"
#include "analysis/errors/summed.h"
#include "analysis/time_series.h"
#include "base/core/types.h"
#include "sim/cell.h"

namespace shaken::analysis {

/// Nematic order in the plane of the plates.
struct NematicOrder {
  double order = 0;     ///< S in [0, 1]; N independent random rods have mean S = sqrt(pi / (4 N)), not 0
  double director = 0;  ///< angle of the mean axis to x, in [-pi/2, pi/2) [rad]
};

/// S = |mean exp(2 i theta)| over the in-plane angles theta of `directors` (n_rods; any length but zero), and the
/// director's angle, half the argument of that mean. A rod exactly upright has no theta: it is left out of the mean.
/// Without any rod that has one, {0, 0}.
NematicOrder nematic_order(std::span<const Vec3> directors);
/// That of the rods of the first species; {NaN, 0} where these are spheres. `directors` (n_rods) are of all species.
NematicOrder nematic_order(const Cell& cell, const std::vector<Vec3>& directors);

/// S(t) and the director's angle, in bounded memory: of a long run a point is the mean over several successive samples,
/// that of the director being the axis of the mean of S exp(2 i theta) (see BoundedSeries). That leaves mean and error
/// of the mean of S as they are; the spread is then that of the averages.
class OrderSeries : public Saved<OrderSeries> {
 public:
  /// Takes a sample at `time` [s], later than all before.
  void accumulate(double time, const NematicOrder& sample);
  void accumulate(double time, std::span<const Vec3> directors) { accumulate(time, nematic_order(directors)); }
  /// Mean, spread and error of S in the steady state (see summarize_series).
  SteadySummary reduce(std::optional<double> steady_start = std::nullopt) const;

  const std::vector<double>& times() const { return series_.times(); }     ///< (n) [s]
  const std::vector<double>& orders() const { return series_.column(0); }  ///< (n)
  std::vector<double> directors() const;                                   ///< (n) [rad], in [-pi/2, pi/2)
  /// Mean of S over the later half of the points so far (the larger half of an odd number); 0 without points.
  double running_mean() const;

  static auto fields(auto& self) { return listed(self.series_); }

 private:
  BoundedSeries<3> series_;  // S, S cos 2 theta, S sin 2 theta
};

/// P[S] and what follows from the moments of S. NaN without samples.
struct OrderDistribution {
  std::vector<double> order;    ///< (bins) bin centres in [0, 1]
  std::vector<double> density;  ///< (bins) probability per unit S; integral 1
  double variance = 0;          ///< of S; times the number of rods it is the susceptibility
  /// U2 = 2 - <S^4> / <S^2>^2, Binder's cumulant for an order with two components: 0 where they are independent
  /// Gaussians (disorder; there it is of order 1 / N), 1 where S does not fluctuate. Curves of different box sizes
  /// against the control parameter cross at a continuous transition (Binder, Z. Phys. B 43, 119 (1981)).
  double binder = 0;
};

/// Histogram and moments of the nematic order S over the samples of a run.
class OrderStatistics : public Summed<OrderStatistics> {
 public:
  /// `bins` equal bins over [0, 1].
  explicit OrderStatistics(int bins);

  /// S of one instant; what is not finite is left out.
  void accumulate(double order);
  OrderDistribution reduce() const;

  static constexpr const char* kName = "OrderStatistics";
  static auto fields(auto& self) { return listed(self.counts_, self.spread_, self.square_, self.fourth_); }

 private:
  std::vector<std::int64_t> counts_;
  Spread spread_;      // of S
  double square_ = 0;  // sum of S^2
  double fourth_ = 0;  // sum of S^4
};

}  // namespace shaken::analysis
