#include "analysis/collision_rates.h"

#include <algorithm>

#include "base/core/check.h"

namespace shaken::analysis {

void CollisionSums::accumulate(double duration, double n_rods, const std::array<double, kCollisionCounts>& added) {
  rod_time_ += duration * n_rods;
  for (std::size_t k = 0; k < kCollisionCounts; ++k) added_[k] += added[k];
}

CollisionRates CollisionSums::reduce() const {
  CollisionRates rates;
  for (std::size_t k = 0; k < kCollisionCounts; ++k) rates[k] = added_[k] / rod_time_;
  rates[static_cast<std::size_t>(CollisionCount::kRodRod)] *= 2;  // of both rods
  return rates;
}

void CollisionSeries::accumulate(double time, const CollisionTotals& totals) {
  if (samples_ > 0) {
    SHAKEN_CHECK(time > time_, "samples must come in order of time");
    std::array<double, kCollisionCounts> added{};
    for (std::size_t k = 0; k < kCollisionCounts; ++k) added[k] = totals.since_start[k] - last_[k];
    CollisionSums one;
    one.accumulate(time - time_, totals.n_rods, added);
    series_.accumulate(time, one.reduce());
    sums_.accumulate(time_, time - time_, totals.n_rods, added);
  }
  ++samples_;
  time_ = time;
  last_ = totals.since_start;
}

}  // namespace shaken::analysis
