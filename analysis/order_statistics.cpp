#include "analysis/order_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/core/check.h"

namespace shaken::analysis {

OrderStatistics::OrderStatistics(int bins) : counts_(static_cast<std::size_t>(std::max(bins, 0))) {
  SHAKEN_CHECK(bins >= 1, "a histogram needs a bin");
}

void OrderStatistics::accumulate(double order) {
  if (!std::isfinite(order)) return;
  const double scaled = std::clamp(order, 0.0, 1.0) * static_cast<double>(counts_.size());
  ++counts_[std::min(static_cast<std::size_t>(scaled), counts_.size() - 1)];
  ++samples_;
  const double from_mean = order - mean_;
  mean_ += from_mean / static_cast<double>(samples_);
  squared_spread_ += from_mean * (order - mean_);
  square_ += order * order;
  fourth_ += order * order * order * order;
}

OrderDistribution OrderStatistics::reduce() const {
  OrderDistribution result;
  const auto bins = static_cast<double>(counts_.size());
  const auto n = static_cast<double>(samples_);
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    result.order.push_back((static_cast<double>(i) + 0.5) / bins);
    result.density.push_back(static_cast<double>(counts_[i]) * bins / n);
  }
  result.variance = squared_spread_ / n;
  result.binder = 2 - fourth_ * n / (square_ * square_);
  return result;
}

void OrderStatistics::merge(const OrderStatistics& other) {
  SHAKEN_CHECK(counts_.size() == other.counts_.size(), "histograms of different bins");
  if (other.samples_ == 0) return;
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  const auto n = static_cast<double>(samples_), m = static_cast<double>(other.samples_);
  const double apart = other.mean_ - mean_;
  mean_ += apart * m / (n + m);
  squared_spread_ += other.squared_spread_ + apart * apart * n * m / (n + m);
  samples_ += other.samples_;
  square_ += other.square_;
  fourth_ += other.fourth_;
}

}  // namespace shaken::analysis
