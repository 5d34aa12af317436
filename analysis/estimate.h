// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <vector>

namespace shaken::analysis {

/// A number that is not to be had, or not known.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A number and its standard error.
struct Estimate {
  double value = kNaN;  ///< NaN: not to be had from the samples
  double sem = kNaN;    ///< NaN: unknown
  /// Independent samples behind the error; NaN: unknown.
  double n_effective = kNaN;
  /// Whether what it averages over is steady; none: it is no average over time, or that cannot be told.
  std::optional<bool> steady = std::nullopt;
};

inline Estimate operator/(Estimate a, double divisor) {
  a.value /= divisor;
  a.sem /= divisor;
  return a;
}

/// Estimates along a curve; both of the curve's length.
struct EstimateCurve {
  std::vector<double> value;
  std::vector<double> sem;

  void push_back(const Estimate& point) {
    value.push_back(point.value);
    sem.push_back(point.sem);
  }
};

}  // namespace shaken::analysis
