#pragma once

#include <limits>
#include <vector>

#include "base/estimate.h"

namespace shaken::analysis {

/// A number that is not to be had, or not known.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using shaken::Estimate;

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
