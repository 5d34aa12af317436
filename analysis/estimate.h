// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

namespace shaken::analysis {

/// A number and the standard error of its mean; NaN where unknown.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double sem = std::numeric_limits<double>::quiet_NaN();
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
