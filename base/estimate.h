#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace shaken {

/// A number and its standard error.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not to be had from the samples
  double sem = std::numeric_limits<double>::quiet_NaN();    ///< NaN: unknown
  /// Independent samples behind the error; NaN: unknown.
  double n_effective = std::numeric_limits<double>::quiet_NaN();
  /// Whether what it averages over is steady; none: it is no average over time, or that cannot be told.
  std::optional<bool> steady = std::nullopt;
  /// Its mean over the later half of the time less that over the earlier one, and the error of this; NaN: unknown.
  double drift = std::numeric_limits<double>::quiet_NaN();
  double drift_sem = std::numeric_limits<double>::quiet_NaN();
};

inline bool is_known(const Estimate& estimate) { return std::isfinite(estimate.value); }

inline Estimate operator/(Estimate a, double divisor) {
  a.value /= divisor;
  a.sem /= divisor;
  a.drift /= divisor;
  a.drift_sem /= divisor;
  return a;
}

/// Mean of independent samples (n >= 1), and its standard error from their scatter: standard deviation (n - 1) /
/// sqrt(n); unknown for n < 2.
Estimate mean_of_samples(std::span<const double> samples);

/// The quantile of Student's t with `freedom` degrees of freedom that corresponds to the quantile `z` of the normal
/// distribution, by its series in 1 / freedom (Abramowitz & Stegun (1964), eq. 26.7.5).
double student_quantile(double z, double freedom);

}  // namespace shaken
