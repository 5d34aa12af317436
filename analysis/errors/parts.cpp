#include "analysis/errors/parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace shaken::analysis {
namespace {

/// What differs by less than this part of itself differs by rounding.
constexpr double kRounding = 1e-11;
/// Beyond this correlation of neighbours there is but one independent part.
constexpr double kMostCorrelation = 0.97;

/// Noise of a series less its mean or trend.
struct Noise {
  double variance;      // of a single part
  double inefficiency;  // g
};

/// The noise of `residuals` about a fit of `fitted` numbers, where the estimate of the correlation has the bias
/// -(bias_0 + bias_1 rho) / n.
Noise noise_of(std::span<const double> residuals, double fitted, double bias_0, double bias_1) {
  const auto n = static_cast<double>(residuals.size());
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    squares += residuals[i] * residuals[i];
    if (i > 0) products += residuals[i] * residuals[i - 1];
  }
  const double raw = squares > 0 ? products / squares : 0.0;
  const double rho = std::clamp(raw + (bias_0 + bias_1 * raw) / n, 0.0, kMostCorrelation);
  return {squares / (n - fitted), (1 + rho) / (1 - rho)};
}

/// Less the mean; exactly zero where all are equal but for rounding.
std::vector<double> about_mean(std::span<const double> parts) {
  std::vector<double> residuals(parts.begin(), parts.end());
  for (double& value : residuals) value -= parts[0];  // first, so that equal parts become exactly zero
  const double mean = mean_of(residuals);
  double largest = 0, deviation = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    residuals[i] -= mean;
    largest = std::max(largest, std::abs(parts[i]));
    deviation = std::max(deviation, std::abs(residuals[i]));
  }
  if (deviation <= kRounding * largest) std::fill(residuals.begin(), residuals.end(), 0.0);
  return residuals;
}

/// Takes from `series` its part along `direction`, which is left unchanged.
void take_off(std::vector<double>& series, std::span<const double> direction) {
  const double along = std::inner_product(series.begin(), series.end(), direction.begin(), 0.0);
  const double norm = std::inner_product(direction.begin(), direction.end(), direction.begin(), 0.0);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] -= along / norm * direction[i];
}

/// Less the least-squares parabola.
std::vector<double> less_parabola(std::span<const double> parts) {
  const double middle = 0.5 * static_cast<double>(parts.size() - 1);
  std::vector<double> residuals(parts.begin(), parts.end()), one(parts.size(), 1.0), line(parts.size()),
      square(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    line[i] = static_cast<double>(i) - middle;
    square[i] = line[i] * line[i];
  }
  take_off(square, one);  // orthogonal to the line by symmetry
  for (const std::vector<double>* direction : {&one, &line, &square}) take_off(residuals, *direction);
  return residuals;
}

}  // namespace

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance_of_mean(std::span<const double> parts) {
  if (parts.size() < 2) return 0.0;
  const Noise noise = noise_of(about_mean(parts), 1, 1, 3);
  return noise.variance * noise.inefficiency / static_cast<double>(parts.size());
}

PartsSummary summarize_parts(std::span<const double> parts) {
  PartsSummary summary{kNaN, kNaN, kNaN, {}, std::nullopt};
  if (parts.empty()) return summary;
  const auto n = static_cast<double>(parts.size());
  const std::vector<double> residuals = about_mean(parts);
  summary.mean = parts[0] - residuals[0];
  if (parts.size() < kFewestParts || !std::isfinite(summary.mean)) return summary;
  const std::span<const double> from_mean = residuals;
  const std::size_t half = parts.size() / 2;
  summary.drift.value = mean_of(from_mean.subspan(half)) - mean_of(from_mean.first(half));
  const Noise noise = noise_of(residuals, 1, 1, 3);
  if (noise.variance == 0) {
    if (n >= kEnoughIndependent) summary.steady = true;
    return summary;
  }
  summary.n_effective = n / noise.inefficiency;
  if (summary.n_effective >= kFewestIndependent) summary.sem = std::sqrt(noise.variance / summary.n_effective);

  const Noise about_trend = noise_of(less_parabola(parts), 3, 3, 5);
  const auto earlier = static_cast<double>(half), later = n - earlier;
  summary.drift.n_effective = n / about_trend.inefficiency;
  summary.drift.sem = std::sqrt(about_trend.variance * about_trend.inefficiency * (1 / earlier + 1 / later));
  if (std::abs(summary.drift.value) > kDriftErrors * summary.drift.sem) {
    summary.steady = false;
  } else if (summary.drift.n_effective >= kEnoughIndependent) {
    summary.steady = true;
  }
  return summary;
}

Estimate estimate_from_parts(double value, std::span<const double> parts) {
  if (!std::isfinite(value)) return {value};
  const PartsSummary summary = summarize_parts(parts);
  return {value, summary.sem, summary.n_effective, summary.steady, summary.drift.value, summary.drift.sem};
}

std::vector<double> parts_of_series(std::span<const double> values) {
  const std::size_t n = std::min(kMostParts, values.size());
  std::vector<double> parts;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t first = i * values.size() / n, end = (i + 1) * values.size() / n;
    parts.push_back(mean_of(values.subspan(first, end - first)));
  }
  return parts;
}

}  // namespace shaken::analysis
