// SPDX-License-Identifier: MIT
#include "analysis/lag_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace shaken::analysis {
namespace {

/// A stretch for errors is at least this many lags long.
constexpr double kLagsPerStretch = 2.0;
/// Fewer stretches say too little of their scatter.
constexpr std::size_t kMinStretches = 4;
/// A lag is trusted for fits if the origins span it this often.
constexpr double kMinIndependent = 10.0;

}  // namespace

LagCurve::LagCurve(std::vector<double> lags, std::vector<double> independent, std::size_t quantities,
                   double stretch_length, std::vector<Stretch> stretches)
    : lags_(std::move(lags)),
      independent_(std::move(independent)),
      quantities_(quantities),
      stretch_length_(stretch_length),
      stretches_(std::move(stretches)),
      rods_(lags_.size()),
      means_(quantities * lags_.size()) {
  for (const Stretch& stretch : stretches_) {
    for (std::size_t i = 0; i < lags_.size(); ++i) rods_[i] += stretch.rods[i];
    for (std::size_t i = 0; i < means_.size(); ++i) means_[i] += stretch.sums[i];
  }
  for (std::size_t i = 0; i < means_.size(); ++i) means_[i] /= rods_[i % lags_.size()];
}

double LagCurve::sem(std::span<const LagTerm> terms) const {
  std::size_t longest = 0;
  for (const LagTerm& term : terms) longest = std::max(longest, term.lag);
  std::size_t joined = 1;
  if (!terms.empty()) {
    const double stretches = kLagsPerStretch * lags_[longest] / stretch_length_;
    joined = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(stretches * (1.0 - 1e-9))));
  }
  double squares = 0;
  std::size_t n = 0;
  for (std::size_t first = 0; first < stretches_.size(); first += joined) {
    double deviation = 0;
    bool counts = false;
    for (std::size_t s = first; s < std::min(first + joined, stretches_.size()); ++s) {
      const Stretch& stretch = stretches_[s];
      for (const LagTerm& term : terms) {
        const std::size_t place = term.quantity * lags_.size() + term.lag;
        const double expected = means_[place] * stretch.rods[term.lag];
        deviation += term.coefficient * (stretch.sums[place] - expected) / rods_[term.lag];
      }
      counts = counts || (!terms.empty() && stretch.rods[longest] > 0);
    }
    squares += deviation * deviation;
    if (counts) ++n;
  }
  if (n < kMinStretches) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(squares * static_cast<double>(n) / static_cast<double>(n - 1));
}

EstimateCurve LagCurve::combination(std::span<const double> weights) const {
  EstimateCurve curve;
  std::vector<LagTerm> terms(weights.size());
  for (std::size_t i = 0; i < lags_.size(); ++i) {
    double value = 0;
    for (std::size_t q = 0; q < weights.size(); ++q) {
      terms[q] = {q, i, weights[q]};
      value += weights[q] * mean(q, i);
    }
    curve.push_back({value, sem(terms)});
  }
  return curve;
}

LagCurve::Window LagCurve::between(double from, double to) const {
  const auto first = std::lower_bound(lags_.begin(), lags_.end(), from * (1.0 - 1e-9));
  const auto end = std::upper_bound(first, lags_.end(), to * (1.0 + 1e-9));
  return {static_cast<std::size_t>(first - lags_.begin()), static_cast<std::size_t>(end - lags_.begin())};
}

LagCurve::Window LagCurve::last_octave() const {
  std::size_t end = lags_.size();
  while (end > 0 && !(independent_[end - 1] >= kMinIndependent)) --end;
  if (end == 0) return {};
  Window window = between(lags_[end - 1] / 2, lags_[end - 1]);
  if (lags_[window.first] == 0.0) ++window.first;
  return window.size() < 3 ? Window{} : window;
}

}  // namespace shaken::analysis
