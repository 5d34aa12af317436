#include "analysis/velocity_correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/lags/lag_fits.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

// Weights of the kernel's quantities.
constexpr double kVelocity[] = {1, 1, 0, 0};
constexpr double kVelocityAlong[] = {1, 0, 0, 0};
constexpr double kVelocityAcross[] = {0, 1, 0, 0};
constexpr double kDirections[] = {0, 0, 1, 0};
constexpr double kDirectionAndVelocity[] = {0, 0, 0, 1};

double product(const LagCurve& curve, std::span<const double> weights, std::size_t lag) {
  double sum = 0;
  for (std::size_t q = 0; q < weights.size(); ++q) sum += weights[q] * curve.mean(q, lag);
  return sum;
}

/// Change of a result with the correlation at one lag.
struct Derivative {
  std::size_t lag = 0;
  double of_result = 0;
};

/// With the error to first order of a result made of means of products.
Estimate estimate_of(const LagCurve& curve, std::span<const double> weights, double value,
                     std::span<const Derivative> derivatives) {
  std::vector<LagTerm> terms;
  for (const Derivative& d : derivatives) {
    for (std::size_t q = 0; q < weights.size(); ++q) terms.push_back({q, d.lag, d.of_result * weights[q]});
  }
  return curve.estimate(value, terms);
}

/// The same made of correlations, which are ratios of means to that at lag zero.
Estimate estimate_of_ratios(const LagCurve& curve, std::span<const double> weights, double value,
                            std::span<const Derivative> derivatives) {
  const double square = product(curve, weights, 0);
  std::vector<Derivative> of_products;
  double by_square = 0;
  for (const Derivative& d : derivatives) {
    of_products.push_back({d.lag, d.of_result / square});
    by_square -= d.of_result * product(curve, weights, d.lag) / square / square;
  }
  of_products.push_back({0, by_square});
  return estimate_of(curve, weights, value, of_products);
}

EstimateCurve correlation(const LagCurve& curve, std::span<const double> weights) {
  EstimateCurve result;
  for (std::size_t lag = 0; lag < curve.lags().size(); ++lag) {
    const Derivative itself{lag, 1.0};
    const double value = product(curve, weights, lag) / product(curve, weights, 0);
    result.push_back(estimate_of_ratios(curve, weights, value, {&itself, 1}));
  }
  return result;
}

/// Integral of the means of products, trapezia on the lags, up to where they first fall to `share` of that at lag zero;
/// NaN where they do not.
struct Integral {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::vector<Derivative> derivatives;
};
Integral integral_to(double share, const LagCurve& curve, std::span<const double> weights) {
  const std::vector<double>& lags = curve.lags();
  const double level = share * product(curve, weights, 0);
  Integral integral;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < lags.size(); ++i) {
    const double width = lags[i + 1] - lags[i];
    const double here = product(curve, weights, i), next = product(curve, weights, i + 1);
    if (next <= level) {  // what is left is a trapezium from `here` to `level`
      const double drop = here - next, squares = here * here - level * level;
      integral.value = sum + width * squares / drop / 2;
      integral.derivatives.push_back({i, width * (2 * here * drop - squares) / (drop * drop) / 2});
      integral.derivatives.push_back({i + 1, width * squares / (drop * drop) / 2});
      integral.derivatives.push_back({0, -width * level / drop * share});
      return integral;
    }
    sum += width * (here + next) / 2;
    integral.derivatives.push_back({i, width / 2});
    integral.derivatives.push_back({i + 1, width / 2});
  }
  return {};
}
Integral integral_to_zero(const LagCurve& curve, std::span<const double> weights) {
  return integral_to(0, curve, weights);
}

/// Up to where the products have fallen to 1/e^2, over the share of an exponential's integral that lies before: all of
/// it where they are one, and never of lags at which there is nothing but noise.
Integral integral_as_of_exponential(const LagCurve& curve, std::span<const double> weights) {
  const double left = std::exp(-2.0);
  Integral integral = integral_to(left, curve, weights);
  integral.value /= 1 - left;
  for (Derivative& d : integral.derivatives) d.of_result /= 1 - left;
  return integral;
}

Estimate estimate(const LagCurve& curve, std::span<const double> weights, const Integral& integral) {
  if (!std::isfinite(integral.value)) return {};
  return estimate_of(curve, weights, integral.value, integral.derivatives);
}

/// The integral of the correlation, which is 1 at lag zero.
Estimate normalised(const LagCurve& curve, std::span<const double> weights, const Integral& integral) {
  if (!std::isfinite(integral.value)) return {};
  const double square = product(curve, weights, 0);
  return estimate_of_ratios(curve, weights, integral.value / square, integral.derivatives);
}

Estimate at_zero(const LagCurve& curve, std::span<const double> weights) {
  const Derivative itself{0, 1.0};
  return estimate_of(curve, weights, product(curve, weights, 0), {&itself, 1});
}

}  // namespace

LagPair<VelocityKernel::kQuantities> VelocityKernel::between(const LagFrame<kColumns>& origin,
                                                             const LagFrame<kColumns>& later) {
  const auto& [x0, y0] = origin.column;
  const auto& [x1, y1] = later.column;
  const double c = std::cos(origin.director);
  const double s = std::sin(origin.director);
  LagPair<kQuantities> pair;
  for (std::size_t i = 0; i < x0.size(); ++i) {
    if (std::isnan(x0[i] + y0[i] + x1[i] + y1[i])) continue;
    pair.rods += 1;
    pair.sums[0] += (c * x0[i] + s * y0[i]) * (c * x1[i] + s * y1[i]);
    pair.sums[1] += (c * y0[i] - s * x0[i]) * (c * y1[i] - s * x1[i]);
    const double before = std::hypot(x0[i], y0[i]), after = std::hypot(x1[i], y1[i]);
    if (!(before > 0 && after > 0)) continue;
    const double way = (x0[i] * x1[i] + y0[i] * y1[i]) / before;
    pair.sums[2] += way / after;
    pair.sums[3] += way;
  }
  return pair;
}

VelocityCorrelation::VelocityCorrelation(double interval, double window, int n_levels)
    : steps_(static_cast<std::size_t>(std::max<long>(1, std::lround(window / interval)))),
      average_(interval, n_levels) {
  SHAKEN_CHECK(window > 0.0, "a velocity is averaged over some time");
}

void VelocityCorrelation::accumulate(double time, std::span<const Vec3> unwrapped, double director) {
  Places now{time, {}};
  now.frame.director = director;
  for (std::vector<double>& column : now.frame.column) column.resize(unwrapped.size());
  for (std::size_t i = 0; i < unwrapped.size(); ++i) {
    now.frame.column[0][i] = unwrapped[i].x();
    now.frame.column[1][i] = unwrapped[i].y();
  }
  if (!places_.empty()) {
    SHAKEN_CHECK(places_.back().frame.column[0].size() == unwrapped.size(), "as many rods as before");
  }
  if (places_.size() == steps_) {
    Places then = std::move(places_.front());
    places_.erase(places_.begin());
    const double window = static_cast<double>(steps_) * average_.interval();
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double>& v = then.frame.column[k];
      for (std::size_t i = 0; i < v.size(); ++i) v[i] = (now.frame.column[k][i] - v[i]) / window;
    }
    average_.accumulate(then.time, std::move(then.frame));
  }
  places_.push_back(std::move(now));
}

VelocityCurve VelocityCorrelation::reduce(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  return {curve.lags(),
          correlation(curve, kVelocity),
          correlation(curve, kVelocityAlong),
          correlation(curve, kVelocityAcross),
          curve.combination(kVelocity),
          curve.combination(kVelocityAlong),
          curve.combination(kVelocityAcross),
          curve.combination(kDirections)};
}

VelocitySummary VelocityCorrelation::summarize(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  VelocitySummary summary;
  if (curve.lags().empty()) return summary;
  summary.correlation_time = normalised(curve, kVelocity, integral_to_zero(curve, kVelocity));
  summary.decay_time = decay_time(curve.lags(), correlation(curve, kVelocity));
  summary.mean_square = at_zero(curve, kVelocity);
  summary.mean_square_along = at_zero(curve, kVelocityAlong);
  summary.mean_square_across = at_zero(curve, kVelocityAcross);
  summary.persistence_time = estimate(curve, kDirections, integral_as_of_exponential(curve, kDirections));
  summary.persistence_length =
      estimate(curve, kDirectionAndVelocity, integral_as_of_exponential(curve, kDirectionAndVelocity));
  return summary;
}

}  // namespace shaken::analysis
