#include "analysis/lags/lag_fits.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace shaken::analysis {
namespace {

/// Between flight, 2, and diffusion, 1: close to the latter, since the exponent of persistent motion falls as slowly as
/// 1 + tau / t.
constexpr double kEndOfFlight = 1.1;
/// Length of the window of short lags.
constexpr double kShortWindow = 4.0;

double mean_square(const LagCurve& curve, std::span<const double> weights, std::size_t lag) {
  double value = 0;
  for (std::size_t q = 0; q < weights.size(); ++q) value += weights[q] * curve.mean(q, lag);
  return value;
}

/// sum of coefficient * MS, or ln MS, over the lags of a window.
Estimate linear(const LagCurve& curve, std::span<const double> weights, const LagCurve::Window& window,
                std::span<const double> coefficients, bool logarithm) {
  double result = 0;
  std::vector<LagTerm> terms;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const std::size_t lag = window.first + i;
    const double value = mean_square(curve, weights, lag);
    if (logarithm && !(value > 0)) return {};
    result += coefficients[i] * (logarithm ? std::log(value) : value);
    const double derivative = coefficients[i] / (logarithm ? value : 1.0);
    for (std::size_t q = 0; q < weights.size(); ++q) terms.push_back({q, lag, derivative * weights[q]});
  }
  return curve.estimate(result, terms);
}

/// Coefficients c with sum c_i y_i = slope of the least-squares line through (x_i, y_i).
std::vector<double> slope_coefficients(std::vector<double> x) {
  double mean = 0, squares = 0;
  for (const double value : x) mean += value / static_cast<double>(x.size());
  for (double& value : x) {
    value -= mean;
    squares += value * value;
  }
  for (double& value : x) value /= squares;
  return x;
}

Estimate line(const LagCurve& curve, std::span<const double> weights, const LagCurve::Window& window, bool logarithm) {
  std::vector<double> x;
  for (std::size_t lag = window.first; lag < window.end; ++lag) {
    x.push_back(logarithm ? std::log(curve.lags()[lag]) : curve.lags()[lag]);
  }
  return linear(curve, weights, window, slope_coefficients(std::move(x)), logarithm);
}

GrowthFit growth_in(const LagCurve& curve, std::span<const double> weights, const LagCurve::Window& window) {
  if (window.size() < 3) return {};
  return {curve.lags()[window.first], curve.lags()[window.end - 1], line(curve, weights, window, false),
          line(curve, weights, window, true)};
}

/// Index of the shortest lag but zero.
std::size_t first_lag(const LagCurve& curve) { return !curve.lags().empty() && curve.lags()[0] == 0.0 ? 1 : 0; }

}  // namespace

ShortAndLong growth(const LagCurve& curve, std::span<const double> weights) {
  const std::vector<double>& lags = curve.lags();
  const std::size_t first = first_lag(curve);
  const LagCurve::Window at_long = curve.last_octave();
  const std::size_t end = at_long.size() > 0 ? at_long.first : lags.size();  // of the short lags
  ShortAndLong result;
  result.at_long = growth_in(curve, weights, at_long);
  if (end <= first) return result;
  // Where the flight ends too late, or not at all, the window stands before the long lags.
  double from = std::max(lags[first], lags[end - 1] / kShortWindow);
  for (std::size_t i = first; i < end && lags[i] < from; ++i) {
    const double exponent =
        std::log(mean_square(curve, weights, i + 1) / mean_square(curve, weights, i)) / std::log(lags[i + 1] / lags[i]);
    if (exponent < kEndOfFlight) from = lags[i];
  }
  result.at_short = growth_in(curve, weights, curve.between(from, std::min(kShortWindow * from, lags[end - 1])));
  return result;
}

EstimateCurve local_exponent(const LagCurve& curve, std::span<const double> weights) {
  EstimateCurve result;
  const std::size_t first = first_lag(curve), n = curve.lags().size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = i > first ? i - 1 : i;
    const std::size_t to = i + 1 < n ? i + 1 : i;
    if (i < first || from == to) {
      result.push_back({});
      continue;
    }
    const LagCurve::Window window{from, to + 1};
    result.push_back(line(curve, weights, window, true));
  }
  return result;
}

Estimate decay_time(std::span<const double> lags, const EstimateCurve& correlation) {
  constexpr double kTarget = 1.0 / std::numbers::e;
  double t0 = 0, c0 = 1, sem0 = 0;
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double t1 = lags[i], c1 = correlation.value[i], sem1 = correlation.sem[i];
    if (c1 <= kTarget) {
      const double share = c1 > 0 ? (std::log(c0) + 1.0) / std::log(c0 / c1) : (c0 - kTarget) / (c0 - c1);
      const double slope = c1 > 0 ? kTarget * std::log(c0 / c1) / (t1 - t0) : (c0 - c1) / (t1 - t0);
      const double sem = std::isnan(sem1) ? sem1 : std::max(sem0, sem1);  // unknown if either is
      return {t0 + share * (t1 - t0), sem / slope};
    }
    t0 = t1;
    c0 = c1;
    sem0 = sem1;
  }
  return {};
}

}  // namespace shaken::analysis
