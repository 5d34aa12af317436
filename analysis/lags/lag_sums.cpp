#include "analysis/lags/lag_sums.h"

#include <algorithm>
#include <utility>

#include "analysis/errors/steady.h"
#include "base/core/check.h"

namespace shaken::analysis {

LagSums::LagSums(std::vector<SampledLag> lags, std::size_t quantities)
    : lags_(std::move(lags)), quantities_(quantities) {}

void LagSums::add(std::int64_t origin, std::size_t lag, double rods, std::span<const double> sums) {
  SHAKEN_CHECK(origin >= 0 && lag < lags_.size() && sums.size() == quantities_, "a pair that these sums know");
  while (origin / samples_per_stretch_ >= static_cast<std::int64_t>(kMaxStretches)) join_neighbours();
  const auto s = static_cast<std::size_t>(origin / samples_per_stretch_);
  if (stretches_.size() <= s) stretches_.resize(s + 1, empty());
  Stretch& stretch = stretches_[s];
  ++stretch.pairs[lag];
  stretch.rods[lag] += rods;
  for (std::size_t q = 0; q < quantities_; ++q) stretch.sums[q * lags_.size() + lag] += sums[q];
}

LagCurve LagSums::after(double t_steady, double start, double interval) const {
  const double stretch_length = static_cast<double>(samples_per_stretch_) * interval;
  std::size_t first = 0;
  while (first < stretches_.size() && !is_steady(start + static_cast<double>(first) * stretch_length, t_steady)) {
    ++first;
  }
  std::vector<std::size_t> met;
  std::vector<double> lags, independent;
  for (std::size_t lag = 0; lag < lags_.size(); ++lag) {
    std::int64_t pairs = 0;
    double rods = 0;
    for (std::size_t s = first; s < stretches_.size(); ++s) {
      pairs += stretches_[s].pairs[lag];
      rods += stretches_[s].rods[lag];
    }
    if (!(rods > 0)) continue;
    const auto [length, spacing] = lags_[lag];
    met.push_back(lag);
    lags.push_back(static_cast<double>(length) * interval);
    independent.push_back(static_cast<double>(pairs) * static_cast<double>(spacing) /
                          static_cast<double>(std::max(length, spacing)));
  }
  std::vector<LagCurve::Stretch> stretches;
  for (std::size_t s = first; s < stretches_.size(); ++s) {
    LagCurve::Stretch stretch;
    for (const std::size_t lag : met) stretch.rods.push_back(stretches_[s].rods[lag]);
    for (std::size_t q = 0; q < quantities_; ++q) {
      for (const std::size_t lag : met) stretch.sums.push_back(stretches_[s].sums[q * lags_.size() + lag]);
    }
    stretches.push_back(std::move(stretch));
  }
  return {std::move(lags), std::move(independent), quantities_, std::move(stretches)};
}

LagSums::Stretch LagSums::empty() const {
  Stretch stretch;
  stretch.pairs.resize(lags_.size());
  stretch.rods.resize(lags_.size());
  stretch.sums.resize(quantities_ * lags_.size());
  return stretch;
}

void LagSums::join_neighbours() {
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    if (s % 2 == 1) {
      stretches_[s / 2].merge(stretches_[s]);
    } else if (s > 0) {
      stretches_[s / 2] = std::move(stretches_[s]);
    }
  }
  stretches_.resize((stretches_.size() + 1) / 2);
  samples_per_stretch_ *= 2;
}

}  // namespace shaken::analysis
