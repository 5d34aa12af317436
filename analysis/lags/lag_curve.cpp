#include "analysis/lags/lag_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace shaken::analysis {
namespace {

/// Stretches for errors are this many lags long ...
constexpr double kLagsPerStretch = 2.0;
/// ... unless there would be fewer than these: then shorter, but not shorter than a lag.
constexpr double kGoodStretches = 8.0;
/// Fewer stretches say too little of their scatter.
constexpr std::size_t kMinStretches = 5;

}  // namespace

LagCurve::LagCurve(std::vector<double> lags, std::vector<double> independent, std::size_t quantities,
                   std::vector<Stretch> stretches)
    : lags_(std::move(lags)),
      independent_(std::move(independent)),
      quantities_(quantities),
      stretches_(std::move(stretches)),
      rods_(lags_.size()),
      means_(quantities * lags_.size()) {
  for (const Stretch& stretch : stretches_) {
    for (std::size_t i = 0; i < lags_.size(); ++i) rods_[i] += stretch.rods[i];
    for (std::size_t i = 0; i < means_.size(); ++i) means_[i] += stretch.sums[i];
  }
  for (std::size_t i = 0; i < means_.size(); ++i) means_[i] /= rods_[i % lags_.size()];
}

LagCurve::Groups LagCurve::groups(std::size_t lag) const {
  Groups groups;
  const double spans = independent_[lag] * (1 + 1e-9);
  const double long_ones = std::floor(spans / kLagsPerStretch);
  double wanted = long_ones >= kGoodStretches ? long_ones : std::min(kGoodStretches, std::floor(spans));
  if (wanted < 1 || !(rods_[lag] > 0)) return groups;
  // No more than there are full stretches, and by the middle of what each holds: the last one, which may be nearly
  // empty, does not stand alone.
  double fullest = 0;
  for (const Stretch& stretch : stretches_) fullest = std::max(fullest, stretch.rods[lag]);
  wanted = std::min(wanted, std::round(rods_[lag] / fullest));
  double before = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const Stretch& stretch : stretches_) {
    const double middle = (before + stretch.rods[lag] / 2) / rods_[lag];
    const auto group = static_cast<std::size_t>(std::min(middle * wanted, wanted - 1));
    if (group != last) ++groups.n;
    last = group;
    groups.of_stretch.push_back(groups.n - 1);
    before += stretch.rods[lag];
  }
  groups.lags_each = std::max(1.0, spans / static_cast<double>(groups.n));
  return groups;
}

Estimate LagCurve::estimate(double value, std::span<const LagTerm> terms) const {
  if (terms.empty()) return {value};
  std::size_t longest = 0;
  for (const LagTerm& term : terms) longest = std::max(longest, term.lag);
  const Groups joined = groups(longest);
  if (joined.n < kMinStretches) return {value};
  std::vector<double> deviations(joined.n);
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    const Stretch& stretch = stretches_[s];
    for (const LagTerm& term : terms) {
      const std::size_t place = term.quantity * lags_.size() + term.lag;
      const double expected = means_[place] * stretch.rods[term.lag];
      deviations[joined.of_stretch[s]] += term.coefficient * (stretch.sums[place] - expected) / rods_[term.lag];
    }
  }
  double squares = 0;
  for (const double deviation : deviations) squares += deviation * deviation;
  const auto n = static_cast<double>(joined.n);
  const double shared = 1 - 1 / (4 * joined.lags_each);
  return {value, std::sqrt(squares * n / (n - 3) / shared), n};
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
    curve.push_back(estimate(value, terms));
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
  while (end > 0 && groups(end - 1).n < kMinStretches) --end;
  if (end == 0) return {};
  Window window = between(lags_[end - 1] / 2, lags_[end - 1]);
  if (lags_[window.first] == 0.0) ++window.first;
  return window.size() < 3 ? Window{} : window;
}

}  // namespace shaken::analysis
