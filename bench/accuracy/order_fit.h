// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

namespace shaken::bench {

/// error = coefficient * dt^order, fitted to the asymptotic part of a series.
struct OrderFit {
  double order = 0;
  double order_error = 0;  ///< standard error, from the scatter about the line
  double coefficient = 0;
  int first = 0;   ///< index of the finest step that counts
  int points = 0;  ///< how many count, from there on
};

/// Least squares in log-log over the asymptotic part of `errors` at rising `steps`. The asymptotic part: steps whose
/// error is at least `kAboveFloor` times `floor`, what the converged solution itself is off by; of these the
/// `kLeast` finest, and each next one while its error stays within a factor `kOnLine` of the line through those before.
/// None if fewer than `kLeast` steps count.
std::optional<OrderFit> fit_order(std::span<const double> steps, std::span<const double> errors, double floor);
inline constexpr double kAboveFloor = 8;
inline constexpr double kOnLine = 1.5;
inline constexpr int kLeast = 4;

}  // namespace shaken::bench
