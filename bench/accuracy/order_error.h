// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "bench/accuracy/fits.h"
#include "bench/case.h"
#include "bench/report.h"

namespace shaken::bench {

/// The statistical error of the mean of S over a stretch of time.
struct StretchError {
  double time = 0;  ///< T, length of the stretches [s]
  int stretches = 0;
  double sem = 0;        ///< scatter of their means
  double sem_error = 0;  ///< its own standard error, sem / sqrt(2 (stretches - 1))
};

/// How the error of S falls with time in one box.
struct OrderError {
  Case scene;
  double measured = 0;               ///< simulated by each replica [s]
  std::vector<Mean> replicas;        ///< S of each, and what its own series says of the error
  double mean = 0;                   ///< of S
  double std = 0;                    ///< of S(t)
  double tau = 0;                    ///< integrated autocorrelation time [s]
  std::vector<StretchError> errors;  ///< rising time
  /// Of sem = c / sqrt(T / 2 tau), from the stretches of at least kLong tau; std if S(t) is one stationary process.
  std::optional<Mean> c;
  double cpu_per_rod_second = 0;

  static constexpr double kLong = 5;

  /// Simulated time until the error of S is `sem` [s].
  double time_for(double sem) const;
  /// CPU time of that, without the way to the steady state [s].
  double cpu_for(double sem) const { return time_for(sem) * scene.system().n_rods * cpu_per_rod_second; }
  /// Scatter of the replicas' means, and what c / sqrt(T / 2 tau) says of it.
  double replica_scatter() const;
  double expected_scatter() const;
};

/// `series`: S(t) of each replica at equal intervals of `every` [s].
OrderError reduce_order(const Case& scene, const std::vector<std::vector<double>>& series, double every);

OrderError measure_order_error(const Case& scene, double measure, int replicas, const Cache& cache);

/// What was measured in small boxes, continued to a large one by power laws of the side.
struct Extrapolation {
  OrderFit std, tau;  ///< against the side [mm]
  double side = 0;    ///< of the large box [mm]
  int n_rods = 0;
  double cpu_per_rod_second = 0;  ///< of the largest box measured

  double time_for(double sem) const;
  double cpu_for(double sem) const { return time_for(sem) * n_rods * cpu_per_rod_second; }
};

/// None from fewer than kLeast boxes, or where a power law does not hold.
std::optional<Extrapolation> extrapolate(const std::vector<OrderError>& measured, const Case& large);

Report order_error_report(const std::vector<OrderError>& measured, const std::optional<Extrapolation>& large);

}  // namespace shaken::bench
