// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace shaken::analysis {

/// A coordinate brought into [0, box_side) by a multiple of the period.
inline double wrapped(double x, double box_side) {
  const double inside = x - box_side * std::floor(x / box_side);
  return inside < box_side ? inside : 0.0;  // rounding can reach the end
}

/// The difference of two wrapped coordinates, brought into [-box_side / 2, box_side / 2] by a period, without a branch.
inline double nearest_image(double difference, double box_side) {
  return difference - box_side * static_cast<double>(static_cast<int>(difference * (2 / box_side)));
}

}  // namespace shaken::analysis
