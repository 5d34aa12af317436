// SPDX-License-Identifier: MIT
#include "bench/fits.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace shaken::bench {
namespace {

/// A least-squares line, and the covariance of its two numbers for errors of 1.
struct Line {
  Eigen::Vector2d at_zero_and_slope;
  Eigen::Matrix2d covariance;
  double squares = 0;  ///< of the residuals
};

/// Through `y` at `x`, each divided by its error.
Line line_through(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y, const Eigen::ArrayXd& errors) {
  Eigen::MatrixX2d design(x.size(), 2);
  design << errors.inverse(), x / errors;
  const Eigen::VectorXd wanted = y / errors;
  Line line;
  line.covariance = (design.transpose() * design).inverse();
  line.at_zero_and_slope = line.covariance * (design.transpose() * wanted);
  line.squares = (wanted - design * line.at_zero_and_slope).squaredNorm();
  return line;
}

Eigen::ArrayXd logarithms(std::span<const double> values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size())).log();
}

/// In log-log, through `points` of them from `first` on.
OrderFit power_through(std::span<const double> steps, std::span<const double> errors, std::size_t first,
                       std::size_t points) {
  const Eigen::ArrayXd x = logarithms(steps.subspan(first, points));
  const double middle = x.mean();
  const Line line = line_through(x - middle, logarithms(errors.subspan(first, points)), Eigen::ArrayXd::Ones(x.size()));
  const double order = line.at_zero_and_slope[1];
  const double scatter = line.squares / (static_cast<double>(points) - 2);
  return {order, std::sqrt(scatter * line.covariance(1, 1)), std::exp(line.at_zero_and_slope[0] - order * middle),
          first, points};
}

/// Half the width of an interval of 95 % confidence in units of the standard error; NaN with too few degrees of
/// freedom.
double student_at_95(double freedom) {
  constexpr double kNormal = 1.9599639845;
  return freedom >= 3 ? student_quantile(kNormal, freedom) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Estimate mean_of_runs(std::span<const Estimate> runs) {
  double sum = 0, squares = 0;
  for (const Estimate& run : runs) {
    sum += run.value;
    squares += run.sem * run.sem;
  }
  const auto n = static_cast<double>(runs.size());
  return {sum / n, std::sqrt(squares) / n};
}

Limit limit_of(std::span<const double> x, std::span<const Estimate> means) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::ArrayXd values(n), errors(n);
  for (std::size_t k = 0; k < x.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = means[k].value;
    errors[static_cast<Eigen::Index>(k)] = means[k].sem;
  }
  const Line line = line_through(Eigen::Map<const Eigen::ArrayXd>(x.data(), n), values, errors);
  return {{line.at_zero_and_slope[0], std::sqrt(line.covariance(0, 0))},
          {line.at_zero_and_slope[1], std::sqrt(line.covariance(1, 1))},
          line.squares,
          static_cast<int>(n) - 2};
}

Estimate relative_bias(const Estimate& of, const Estimate& truth) {
  const double ratio = of.value / truth.value;
  return {ratio - 1, std::hypot(of.sem / truth.value, ratio * truth.sem / truth.value)};
}

const char* verdict(const Estimate& bias, double bound) {
  if (std::abs(bias.value) + 2 * bias.sem < bound) return "below";
  return std::abs(bias.value) - 2 * bias.sem > bound ? "above" : "open";
}

std::optional<OrderFit> fit_order(std::span<const double> steps, std::span<const double> errors, double floor) {
  const std::size_t n = steps.size();
  std::size_t first = 0;
  while (first < n && !(errors[first] > 0 && errors[first] >= kAboveFloor * floor)) ++first;
  if (n - first < kLeast) return std::nullopt;
  if (!std::all_of(errors.begin() + static_cast<std::ptrdiff_t>(first), errors.end(), [](double e) { return e > 0; })) {
    return std::nullopt;
  }
  OrderFit fit = power_through(steps, errors, first, kLeast);
  for (std::size_t next = first + kLeast; next < n; ++next) {
    const double expected = fit.coefficient * std::pow(steps[next], fit.order);
    if (std::abs(std::log(errors[next] / expected)) > std::log(kOnLine)) break;
    fit = power_through(steps, errors, first, fit.points + 1);
  }
  return fit;
}

Quartiles quartiles_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], place - static_cast<double>(below));
  };
  return {at(0.25), at(0.5), at(0.75)};
}

double Apart::farthest() const { return std::abs(difference) + half_width; }
double Apart::nearest() const { return std::abs(difference) - half_width; }

Sameness Apart::within(double bound) const {
  if (farthest() <= bound) return Sameness::kSame;
  return nearest() > bound ? Sameness::kDifferent : Sameness::kOpen;
}

Apart compare_means(std::span<const double> first, std::span<const double> second) {
  const Estimate a = mean_of_samples(first), b = mean_of_samples(second);
  const double size = std::abs(a.value + b.value) / 2;
  const double of_a = a.sem * a.sem, of_b = b.sem * b.sem, variance = of_a + of_b;
  const double freedom =
      variance * variance /
      (of_a * of_a / (static_cast<double>(first.size()) - 1) + of_b * of_b / (static_cast<double>(second.size()) - 1));
  return {(b.value - a.value) / size, student_at_95(freedom) * std::sqrt(variance) / size};
}

}  // namespace shaken::bench
