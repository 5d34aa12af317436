// SPDX-License-Identifier: MIT
#include "analysis/tilt_summary.h"

#include <cmath>

namespace shaken::analysis {
namespace {

/// A bin counts as moving if its velocity is more than this many of its errors.
constexpr double kSignificant = 3.0;

}  // namespace

FoldedTilt fold_tilt(const TiltCurve& curve) {
  FoldedTilt folded;
  const std::size_t n = curve.n_z.size();
  for (std::size_t up = (n + 1) / 2; up < n; ++up) {
    const std::size_t down = n - 1 - up;
    double w_up = curve.density[up], w_down = curve.density[down];
    if (!(w_up + w_down > 0)) continue;
    const double density = w_up + w_down;
    const bool error_up = std::isfinite(curve.v_along_sem[up]), error_down = std::isfinite(curve.v_along_sem[down]);
    if (error_up && !error_down) w_down = 0;
    if (error_down && !error_up) w_up = 0;
    double sum = 0, variance = 0;
    if (w_up > 0) {
      sum += w_up * curve.v_along[up];
      variance += std::pow(w_up * curve.v_along_sem[up], 2);
    }
    if (w_down > 0) {
      sum -= w_down * curve.v_along[down];
      variance += std::pow(w_down * curve.v_along_sem[down], 2);
    }
    folded.n_z.push_back(curve.n_z[up]);
    folded.density.push_back(density);
    folded.v_along.push_back({sum / (w_up + w_down), std::sqrt(variance) / (w_up + w_down)});
  }
  return folded;
}

TiltSummary summarize_tilt(const TiltCurve& curve) {
  const FoldedTilt folded = fold_tilt(curve);
  const std::vector<double>& v = folded.v_along.value;
  const std::vector<double>& sem = folded.v_along.sem;
  TiltSummary summary;
  std::size_t largest = v.size();
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!(std::abs(v[i]) > kSignificant * sem[i])) continue;
    if (largest == v.size() || std::abs(v[i]) > std::abs(v[largest])) largest = i;
  }
  if (largest == v.size()) return summary;
  summary.v_largest = {v[largest], sem[largest]};
  summary.n_z_largest = folded.n_z[largest];

  const double sign = v[largest] > 0 ? 1.0 : -1.0;
  for (std::size_t i = largest; i + 1 < v.size(); ++i) {
    if (!(sign * v[i] > 0 && sign * v[i + 1] <= 0)) continue;
    double sum = 0, variance = 0;
    for (std::size_t j = i + 1; j < v.size(); ++j) {
      if (!std::isfinite(sem[j])) continue;
      sum -= sign * folded.density[j] * v[j];
      variance += std::pow(folded.density[j] * sem[j], 2);
    }
    const double sigma = sum / std::sqrt(variance);
    if (std::isnan(sigma)) continue;
    if (std::isnan(summary.zero_sigma) || sigma > summary.zero_sigma) {
      const double share = v[i] / (v[i] - v[i + 1]);
      summary.n_z_zero = folded.n_z[i] + share * (folded.n_z[i + 1] - folded.n_z[i]);
      summary.zero_sigma = sigma;
    }
  }
  return summary;
}

}  // namespace shaken::analysis
