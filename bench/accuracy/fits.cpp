// SPDX-License-Identifier: MIT
#include "bench/accuracy/fits.h"

#include <algorithm>
#include <cmath>

namespace shaken::bench {

Mean mean_of_samples(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  double sum = 0, squares = 0;
  for (const double sample : samples) sum += sample;
  for (const double sample : samples) squares += (sample - sum / n) * (sample - sum / n);
  return {sum / n, std::sqrt(squares / (n - 1) / n)};
}

Limit limit_of(std::span<const double> x, std::span<const Mean> means) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double weight = 1 / (means[k].sem * means[k].sem);
    s += weight;
    sx += weight * x[k];
    sy += weight * means[k].value;
    sxx += weight * x[k] * x[k];
    sxy += weight * x[k] * means[k].value;
  }
  const double determinant = s * sxx - sx * sx;
  Limit limit;
  limit.at_zero = {(sxx * sy - sx * sxy) / determinant, std::sqrt(sxx / determinant)};
  limit.slope = {(s * sxy - sx * sy) / determinant, std::sqrt(s / determinant)};
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double off = (means[k].value - limit.at_zero.value - limit.slope.value * x[k]) / means[k].sem;
    limit.chi_squared += off * off;
  }
  limit.freedom = static_cast<int>(x.size()) - 2;
  return limit;
}

Mean relative_bias(const Mean& of, const Mean& truth) {
  const double ratio = of.value / truth.value;
  return {ratio - 1, std::hypot(of.sem / truth.value, ratio * truth.sem / truth.value)};
}

Verdict judge(const Mean& bias, double bound) {
  if (std::abs(bias.value) + 2 * bias.sem < bound) return Verdict::kBelow;
  if (std::abs(bias.value) - 2 * bias.sem > bound) return Verdict::kAbove;
  return Verdict::kOpen;
}

std::optional<std::size_t> last_below(std::span<const Mean> biases, double bound) {
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < biases.size() && judge(biases[k], bound) == Verdict::kBelow; ++k) last = k;
  return last;
}

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

Quartiles quartiles_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

}  // namespace shaken::bench
