#include "analysis/self_scattering.h"

#include <cmath>
#include <utility>

#include "analysis/lags/lag_fits.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

constexpr std::size_t kMoments = 2 * kScatteringWaves;  ///< place of the first of the moments
using Weights = std::array<double, ScatteringKernel::kQuantities>;

/// Weights of moments a^2, b^2, a^4, b^4, a^2 b^2.
constexpr Weights of_moments(double aa, double bb, double aaaa, double bbbb, double aabb) {
  Weights weights{};
  const double moments[] = {aa, bb, aaaa, bbbb, aabb};
  for (std::size_t k = 0; k < 5; ++k) weights[kMoments + k] = moments[k];
  return weights;
}

/// <r^4> / (c <r^2>^2) - 1; NaN where nothing moves.
EstimateCurve non_gaussian(const LagCurve& curve, const Weights& second, const Weights& fourth, double c) {
  EstimateCurve result;
  for (std::size_t lag = 0; lag < curve.lags().size(); ++lag) {
    double square = 0, quartic = 0;
    for (std::size_t q = 0; q < second.size(); ++q) {
      square += second[q] * curve.mean(q, lag);
      quartic += fourth[q] * curve.mean(q, lag);
    }
    const double ratio = quartic / (c * square * square);
    if (!(square > 0)) {
      result.push_back({});
      continue;
    }
    std::vector<LagTerm> terms;
    for (std::size_t q = 0; q < second.size(); ++q) {
      terms.push_back({q, lag, fourth[q] / (c * square * square) - 2 * ratio * second[q] / square});
    }
    result.push_back(curve.estimate(ratio - 1, terms));
  }
  return result;
}

}  // namespace

LagPair<ScatteringKernel::kQuantities> ScatteringKernel::between(const LagFrame<kColumns>& origin,
                                                                 const LagFrame<kColumns>& later) {
  const auto& [x0, y0] = origin.column;
  const auto& [x1, y1] = later.column;
  const double c = std::cos(origin.director), s = std::sin(origin.director);
  LagPair<kQuantities> pair;
  for (std::size_t i = 0; i < x0.size(); ++i) {
    const double dx = x1[i] - x0[i], dy = y1[i] - y0[i];
    if (std::isnan(dx + dy)) continue;
    pair.rods += 1;
    const double a = c * dx + s * dy, b = c * dy - s * dx;
    double cosine_a = std::cos(a), cosine_b = std::cos(b);
    for (std::size_t wave = 0; wave < kScatteringWaves; ++wave) {
      pair.sums[wave] += cosine_a;
      pair.sums[kScatteringWaves + wave] += cosine_b;
      cosine_a = 2 * cosine_a * cosine_a - 1;  // of twice the angle
      cosine_b = 2 * cosine_b * cosine_b - 1;
    }
    const double aa = a * a, bb = b * b;
    pair.sums[kMoments] += aa;
    pair.sums[kMoments + 1] += bb;
    pair.sums[kMoments + 2] += aa * aa;
    pair.sums[kMoments + 3] += bb * bb;
    pair.sums[kMoments + 4] += aa * bb;
  }
  return pair;
}

SelfScattering::SelfScattering(double interval, double wavelength, int n_levels)
    : smallest_(2 * kPi / wavelength), average_(interval, n_levels) {
  SHAKEN_CHECK(wavelength > 0, "waves have a length");
}

std::vector<double> SelfScattering::wave_numbers() const {
  std::vector<double> q{smallest_};
  while (q.size() < kScatteringWaves) q.push_back(2 * q.back());
  return q;
}

void SelfScattering::accumulate(double time, std::span<const Vec3> unwrapped, double director) {
  LagFrame<ScatteringKernel::kColumns> frame;
  frame.director = director;
  for (std::vector<double>& column : frame.column) column.resize(unwrapped.size());
  for (std::size_t i = 0; i < unwrapped.size(); ++i) {
    frame.column[0][i] = smallest_ * unwrapped[i].x();
    frame.column[1][i] = smallest_ * unwrapped[i].y();
  }
  average_.accumulate(time, std::move(frame));
}

ScatteringCurve SelfScattering::reduce(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  ScatteringCurve result;
  result.lag = curve.lags();
  for (std::size_t wave = 0; wave < kScatteringWaves; ++wave) {
    Weights along{}, across{}, mean{};
    along[wave] = across[kScatteringWaves + wave] = 1;
    mean[wave] = mean[kScatteringWaves + wave] = 0.5;
    result.along[wave] = curve.combination(along);
    result.across[wave] = curve.combination(across);
    result.mean[wave] = curve.combination(mean);
  }
  result.alpha_2 = non_gaussian(curve, of_moments(1, 1, 0, 0, 0), of_moments(0, 0, 1, 1, 2), 2);
  result.alpha_2_along = non_gaussian(curve, of_moments(1, 0, 0, 0, 0), of_moments(0, 0, 1, 0, 0), 3);
  result.alpha_2_across = non_gaussian(curve, of_moments(0, 1, 0, 0, 0), of_moments(0, 0, 0, 1, 0), 3);
  return result;
}

ScatteringSummary SelfScattering::summarize(const ScatteringCurve& curve) {
  ScatteringSummary summary;
  for (std::size_t wave = 0; wave < kScatteringWaves; ++wave) {
    summary.relaxation[wave] = decay_time(curve.lag, curve.mean[wave]);
  }
  for (std::size_t lag = 0; lag < curve.lag.size(); ++lag) {
    const double value = curve.alpha_2.value[lag], sem = curve.alpha_2.sem[lag];
    if (!std::isfinite(sem) || value <= summary.alpha_2_peak.value) continue;
    summary.alpha_2_peak = {value, sem};
    summary.alpha_2_peak_lag = curve.lag[lag];
  }
  return summary;
}

}  // namespace shaken::analysis
