#include "analysis/time_series.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/errors/parts.h"
#include "analysis/errors/steady.h"

namespace shaken::analysis {
namespace {

/// Sokal's window closes at this many statistical inefficiencies: the constant of emcee.
constexpr double kWindow = 5.0;
/// Products spent on one level of averaging before the series is halved. Series up to about 8000 are never halved.
constexpr std::size_t kBudget = std::size_t{1} << 25;
/// Chodera's search works on at most this many points.
constexpr std::size_t kSearchPoints = 512;
/// A series worth more samples by the sum over lags has its error from that alone.
constexpr double kWorthMany = 500;
/// It takes the first t0 that leaves this share of the most samples: what is left differs by chance.
constexpr double kNearlyMost = 0.9;

/// Less the mean. Taken from the first value before, so that a constant series becomes exactly zero.
std::vector<double> centred(std::span<const double> values) {
  std::vector<double> x(values.size());
  std::transform(values.begin(), values.end(), x.begin(), [&](double value) { return value - values[0]; });
  const double mean = mean_of(x);
  for (double& value : x) value -= mean;
  return x;
}

/// Sum of x_i x_(i + lag); four running sums, since one would wait for its own last addition.
double product_sum(std::span<const double> x, std::size_t lag) {
  const std::size_t n = x.size() - lag;
  double sums[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sums[k] += x[i + k] * x[i + k + lag];
  }
  for (; i < n; ++i) sums[0] += x[i] * x[i + lag];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// Means of successive groups of `length`; an incomplete last group is left out.
std::vector<double> group_means(std::span<const double> values, std::size_t length) {
  std::vector<double> means(values.size() / length);
  for (std::size_t i = 0; i < means.size(); ++i) means[i] = mean_of(values.subspan(i * length, length));
  return means;
}

/// Samples worth one independent one each, by the error that parts of the series give its mean.
double effective_samples(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double of_mean = variance_of_mean(parts_of_series(values));
  if (of_mean == 0.0) return n;
  const std::vector<double> x = centred(values);
  return std::min(n, product_sum(x, 0) / (n - 1.0) / of_mean);
}

/// Index at which a series has come back from its first value to the mean of its later half; its size if it never does.
std::size_t first_return(std::span<const double> values) {
  const double later = mean_of(values.subspan(values.size() / 2));
  if (std::abs(values[0] - later) <= 1e-12 * std::abs(later)) return 0;  // but for rounding
  const bool from_above = values[0] > later;
  std::size_t i = 0;
  while (i < values.size() && (from_above ? values[i] > later : values[i] < later)) ++i;
  return i;
}

}  // namespace

double statistical_inefficiency(std::span<const double> values) {
  if (values.size() < 4) return 1.0;
  std::vector<double> x = centred(values);
  const double variance = product_sum(x, 0) / static_cast<double>(x.size());
  if (variance == 0.0) return 1.0;

  for (double averaged = 1.0;; averaged *= 2.0) {
    const std::size_t n = x.size();
    const double c0 = product_sum(x, 0);
    if (c0 == 0.0) return 1.0;  // pairs that cancel exactly: anything but correlated
    double g = 1.0;
    std::size_t spent = 0;
    bool closed = false;
    for (std::size_t lag = 1; lag < n && spent <= kBudget && !closed; ++lag) {
      g += 2.0 * product_sum(x, lag) / c0;
      spent += n - lag;
      closed = static_cast<double>(lag) >= kWindow * g;
    }
    if (closed || spent <= kBudget) {
      // The error of the mean, variance * g / n, is the same for the averaged series.
      const double of_samples = averaged * g * (c0 / static_cast<double>(n)) / variance;
      return std::clamp(of_samples, 1.0, static_cast<double>(values.size()));
    }
    x = group_means(x, 2);
  }
}

std::size_t steady_index(std::span<const double> values) {
  if (values.empty()) return 0;
  const std::size_t group = (values.size() + kSearchPoints - 1) / kSearchPoints;
  const std::vector<double> points = group_means(values, group);
  const std::size_t last = 3 * points.size() / 4;
  const auto from = [&](std::size_t t0) { return std::span<const double>(points).subspan(t0); };

  std::vector<double> n_effective;
  for (std::size_t t0 = 0; t0 <= last; ++t0) n_effective.push_back(effective_samples(from(t0)));
  std::size_t t0 = std::min(last, (first_return(values) + group - 1) / group);
  const auto first = n_effective.begin() + static_cast<std::ptrdiff_t>(t0);
  const double enough = kNearlyMost * *std::max_element(first, n_effective.end());
  while (n_effective[t0] < enough) ++t0;
  const bool drifts = summarize_parts(parts_of_series(from(t0))).steady == false;
  return (drifts ? last : t0) * group;
}

SteadySummary summarize_series(std::span<const double> times, std::span<const double> values,
                               std::optional<double> steady_start) {
  std::size_t first = 0;
  if (steady_start) {
    while (first < times.size() && !is_steady(times[first], *steady_start)) ++first;
  } else {
    first = steady_index(values);
  }
  SteadySummary summary;
  summary.t_steady = first < times.size() ? times[first] : steady_start.value_or(0.0);
  const std::span<const double> steady = values.subspan(first);
  if (steady.empty()) return summary;

  const double n = static_cast<double>(steady.size());
  const std::vector<double> x = centred(steady);
  const double g = statistical_inefficiency(steady);
  const PartsSummary parts = summarize_parts(parts_of_series(steady));
  summary.mean = steady[0] - x[0];
  summary.n_effective = n / g > kWorthMany ? n / g : std::min(n / g, effective_samples(steady));
  summary.drift = parts.drift;
  const bool long_enough = !(parts.drift.n_effective < kEnoughForSteadyState);  // NaN: nothing varies
  const bool early_enough = steady_start || 2 * first <= values.size();
  if (parts.steady == false || !early_enough) {
    summary.steady = false;
  } else if (parts.steady == true && long_enough) {
    summary.steady = true;
  }
  if (steady.size() < 2) return summary;
  summary.std = std::sqrt(product_sum(x, 0) / (n - 1.0));
  if (std::isfinite(parts.sem)) summary.sem = summary.std / std::sqrt(summary.n_effective);
  summary.tau = 0.5 * (g - 1.0) * (times.back() - times[first]) / (n - 1.0);
  return summary;
}

}  // namespace shaken::analysis
