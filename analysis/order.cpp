#include "analysis/order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "analysis/geometry/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// The angle of an axis from the cosine and sine of twice it, times any length.
double axis_of(double cosine, double sine) { return fold_half_turn(0.5 * std::atan2(sine, cosine)); }

}  // namespace

NematicOrder nematic_order(std::span<const Vec3> directors) {
  Vec2 sum = Vec2::Zero();
  std::size_t n = 0;
  for (const Vec3& director : directors) {
    const Vec2 angle = double_angle(director);
    if (angle == Vec2::Zero()) continue;
    sum += angle;
    ++n;
  }
  if (n == 0) return {};
  return {std::min(1.0, sum.norm() / static_cast<double>(n)), axis_of(sum.x(), sum.y())};
}

NematicOrder nematic_order(const Cell& cell, const std::vector<Vec3>& directors) {
  if (!cell.has_axes()) return {.order = std::numeric_limits<double>::quiet_NaN(), .director = 0};
  return nematic_order(cell.of_species(0, directors));
}

void OrderSeries::accumulate(double time, const NematicOrder& sample) {
  const double angle = 2 * sample.director;
  series_.accumulate(time, {sample.order, sample.order * std::cos(angle), sample.order * std::sin(angle)});
}

SteadySummary OrderSeries::reduce(std::optional<double> steady_start) const {
  return summarize_series(times(), orders(), steady_start);
}

std::vector<double> OrderSeries::directors() const {
  std::vector<double> result(times().size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = axis_of(series_.column(1)[i], series_.column(2)[i]);
  return result;
}

double OrderSeries::running_mean() const {
  const std::span<const double> later = std::span(orders()).subspan(orders().size() / 2);
  return later.empty() ? 0.0 : std::accumulate(later.begin(), later.end(), 0.0) / static_cast<double>(later.size());
}

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
