// SPDX-License-Identifier: MIT
#include "bench/accuracy/order_fit.h"

#include <cmath>

namespace shaken::bench {
namespace {

/// y = order x + log(coefficient) through points [first, first + points) in log-log.
OrderFit line_through(std::span<const double> steps, std::span<const double> errors, int first, int points) {
  const double n = points;
  double x_mean = 0, y_mean = 0;
  for (int k = first; k < first + points; ++k) {
    x_mean += std::log(steps[k]) / n;
    y_mean += std::log(errors[k]) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (int k = first; k < first + points; ++k) {
    const double x = std::log(steps[k]) - x_mean;
    const double y = std::log(errors[k]) - y_mean;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const double order = xy / xx;
  const double scatter = std::max(0.0, yy - order * xy) / (n - 2);
  return {order, std::sqrt(scatter / xx), std::exp(y_mean - order * x_mean), first, points};
}

}  // namespace

std::optional<OrderFit> fit_order(std::span<const double> steps, std::span<const double> errors, double floor) {
  const int n = static_cast<int>(steps.size());
  int first = 0;
  while (first < n && !(errors[first] > 0 && errors[first] >= kAboveFloor * floor)) ++first;
  if (n - first < kLeast) return std::nullopt;
  for (int k = first; k < n; ++k) {
    if (!(errors[k] > 0)) return std::nullopt;
  }
  OrderFit fit = line_through(steps, errors, first, kLeast);
  for (int next = first + kLeast; next < n; ++next) {
    const double expected = fit.coefficient * std::pow(steps[next], fit.order);
    if (std::abs(std::log(errors[next] / expected)) > std::log(kOnLine)) break;
    fit = line_through(steps, errors, first, fit.points + 1);
  }
  return fit;
}

}  // namespace shaken::bench
