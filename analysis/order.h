// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/state_io.h"
#include "analysis/time_series.h"
#include "sim/core/types.h"

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

/// S(t) and the director's angle. Grows by three numbers a sample.
class OrderSeries {
 public:
  /// Takes a sample at `time` [s], later than all before.
  void accumulate(double time, std::span<const Vec3> directors);
  /// Mean, spread and error of S in the steady state (see summarize_series).
  SteadySummary reduce(std::optional<double> steady_start = std::nullopt) const;
  void reset();

  const std::vector<double>& times() const { return times_; }          ///< (n) [s]
  const std::vector<double>& orders() const { return orders_; }        ///< (n)
  const std::vector<double>& directors() const { return directors_; }  ///< (n) [rad], in [-pi/2, pi/2)
  /// Mean of S over the later half of the samples so far (the larger half of an odd number); 0 without samples.
  double running_mean() const;

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  std::vector<double> times_, orders_, directors_;
  double later_half_sum_ = 0;  // of orders_[n / 2 .. n)
};

}  // namespace shaken::analysis
