// SPDX-License-Identifier: MIT
// What measured errors and means are reduced to.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/estimate.h"

namespace shaken::bench {

/// The mean over independent runs of one length.
Estimate mean_of_runs(std::span<const Estimate> runs);

/// The straight line value + slope * x through measured means, by weighted least squares.
struct Limit {
  Estimate at_zero;        ///< the limit x -> 0
  Estimate slope;          ///< per unit of x
  double chi_squared = 0;  ///< sum of squared residuals over their errors; about `freedom` if the line holds
  int freedom = 0;
};

/// `x` and `means` of one length, at least two different x; every sem > 0.
Limit limit_of(std::span<const double> x, std::span<const Estimate> means);

/// (of - truth) / truth; the error is of both, taken as independent.
Estimate relative_bias(const Estimate& of, const Estimate& truth);

/// "below", "above" or "open": whether the bias is below `bound` in size, with two standard errors to spare; open where
/// they do not tell.
const char* verdict(const Estimate& bias, double bound);

/// error = coefficient * dt^order, fitted to the asymptotic part of a series.
struct OrderFit {
  double order = 0;
  double order_error = 0;  ///< standard error, from the scatter about the line
  double coefficient = 0;
  std::size_t first = 0;   ///< index of the finest step that counts
  std::size_t points = 0;  ///< how many count, from there on
};

/// Least squares in log-log over the asymptotic part of `errors` at rising `steps`. The asymptotic part: steps whose
/// error is at least `kAboveFloor` times `floor`, what the converged solution itself is off by; of these the
/// `kLeast` finest, and each next one while its error stays within a factor `kOnLine` of the line through those before.
/// None if fewer than `kLeast` steps count.
std::optional<OrderFit> fit_order(std::span<const double> steps, std::span<const double> errors, double floor);
inline constexpr double kAboveFloor = 8;
inline constexpr double kOnLine = 1.5;
inline constexpr std::size_t kLeast = 4;

/// The middle of a sample and the range of its middle half.
struct Quartiles {
  double lower = 0, median = 0, upper = 0;
};

/// Linear between neighbours of the sorted values (the usual definition); `values` is not empty.
Quartiles quartiles_of(std::vector<double> values);

/// What is known of whether a mean is the same in two places.
enum class Sameness {
  kSame,       ///< all of the interval of confidence lies within the bound
  kDifferent,  ///< all of it lies beyond
  kOpen,       ///< neither: too few samples to tell
};

/// How far apart two means are, as fractions of the size of the mean of both.
struct Apart {
  double difference = 0;  ///< of the second less the first
  double half_width = 0;  ///< of its interval of 95 % confidence; NaN where there are too few samples for one

  /// The end of the interval that is farther from nought.
  double farthest() const;
  double nearest() const;
  /// Whether they are the same but for `bound`. That no difference was seen does not make two means the same: the
  /// interval must exclude one as large as the bound, so that too few samples leave the question open.
  Sameness within(double bound) const;
};

/// Of independent samples, each of which is as good as any other. The interval is Welch's (Biometrika 34, 28 (1947)),
/// with student_quantile, which needs three degrees of freedom at least.
Apart compare_means(std::span<const double> first, std::span<const double> second);

}  // namespace shaken::bench
