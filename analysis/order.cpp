// SPDX-License-Identifier: MIT
#include "analysis/order.h"

#include <algorithm>
#include <cmath>

#include "analysis/fold.h"
#include "sim/core/check.h"

namespace shaken::analysis {

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
  return {std::min(1.0, sum.norm() / static_cast<double>(n)), fold_half_turn(0.5 * std::atan2(sum.y(), sum.x()))};
}

void OrderSeries::accumulate(double time, std::span<const Vec3> directors) {
  SHAKEN_CHECK(times_.empty() || time > times_.back(), "samples must come in order of time");
  const NematicOrder sample = nematic_order(directors);
  times_.push_back(time);
  orders_.push_back(sample.order);
  directors_.push_back(sample.director);
  later_half_sum_ += sample.order;
  if (const std::size_t n = orders_.size(); n % 2 == 0) later_half_sum_ -= orders_[n / 2 - 1];
}

SteadySummary OrderSeries::reduce(std::optional<double> steady_start) const {
  return summarize_series(times_, orders_, steady_start);
}

void OrderSeries::reset() { *this = {}; }

double OrderSeries::running_mean() const {
  const std::size_t n = orders_.size();
  return n == 0 ? 0.0 : later_half_sum_ / static_cast<double>(n - n / 2);
}

void OrderSeries::save(StateWriter& writer) const {
  writer.tag("OrderSeries");
  writer.put(times_);
  writer.put(orders_);
  writer.put(directors_);
  writer.put(later_half_sum_);
}

void OrderSeries::restore(StateReader& reader) {
  reader.tag("OrderSeries");
  OrderSeries saved;
  saved.times_ = reader.reals();
  saved.orders_ = reader.reals(saved.times_.size());
  saved.directors_ = reader.reals(saved.times_.size());
  saved.later_half_sum_ = reader.real();
  *this = std::move(saved);
}

}  // namespace shaken::analysis
