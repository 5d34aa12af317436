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
  spread_.accumulate(order);
  square_ += order * order;
  fourth_ += order * order * order * order;
}

OrderDistribution OrderStatistics::reduce() const {
  OrderDistribution result;
  const auto bins = static_cast<double>(counts_.size());
  const auto n = static_cast<double>(spread_.samples);
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    result.order.push_back((static_cast<double>(i) + 0.5) / bins);
    result.density.push_back(static_cast<double>(counts_[i]) * bins / n);
  }
  result.variance = spread_.variance();
  result.binder = 2 - fourth_ * n / (square_ * square_);
  return result;
}

}  // namespace shaken::analysis
