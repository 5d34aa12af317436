// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

namespace shaken::analysis {

/// A number and its standard error.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not to be had from the samples
  double sem = std::numeric_limits<double>::quiet_NaN();    ///< NaN: unknown
};

inline Estimate operator/(const Estimate& a, double divisor) { return {a.value / divisor, a.sem / divisor}; }

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
