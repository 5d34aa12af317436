#include "analysis/van_hove.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/bins.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

constexpr int kVanHoveLags = 4;

std::vector<double> densities(const std::vector<std::int64_t>& counts, double of_one) {
  std::vector<double> values;
  values.reserve(counts.size());
  for (const std::int64_t count : counts) values.push_back(static_cast<double>(count) * of_one);
  return values;
}

}  // namespace

DisplacementHistogram::DisplacementHistogram(int bins, double range)
    : range_(range), along_(static_cast<std::size_t>(std::max(bins, 0))), across_(along_.size()), distance_(along_) {
  SHAKEN_CHECK(bins >= 1 && range > 0, "bins and range must not be empty");
}

void DisplacementHistogram::accumulate(std::span<const Vec2> displacements, double director) {
  const double c = std::cos(director), s = std::sin(director);
  const double bins_per_mm = static_cast<double>(along_.size()) / range_;
  const auto count = [&](std::vector<std::int64_t>& bins, double magnitude) {
    const double place = magnitude * bins_per_mm;
    if (place < static_cast<double>(bins.size())) ++bins[static_cast<std::size_t>(place)];
  };
  for (const Vec2& d : displacements) {
    count(along_, std::abs(c * d.x() + s * d.y()));
    count(across_, std::abs(c * d.y() - s * d.x()));
    count(distance_, std::hypot(d.x(), d.y()));
  }
  rods_ += static_cast<std::int64_t>(displacements.size());
}

DisplacementCurve DisplacementHistogram::reduce() const {
  const double width = range_ / static_cast<double>(along_.size());
  const double of_one = 1 / (width * static_cast<double>(rods_));
  DisplacementCurve curve{
      {}, densities(along_, of_one / 2), densities(across_, of_one / 2), densities(distance_, of_one)};
  if (rods_ == 0) curve.along = curve.across = curve.distance = std::vector<double>(along_.size(), kNaN);
  curve.displacement = middles_of_bins(along_.size(), width);
  const auto within = std::accumulate(distance_.begin(), distance_.end(), std::int64_t{0});
  curve.beyond = static_cast<double>(rods_ - within) / static_cast<double>(rods_);
  return curve;
}

VanHove::VanHove(double interval, double longest, int bins, double range) : interval_(interval) {
  SHAKEN_CHECK(interval > 0 && longest > 0, "samples must follow each other");
  for (int k = kVanHoveLags - 1; k >= 0; --k) {
    const auto steps = std::max<std::int64_t>(1, std::llround(std::ldexp(longest / interval, -2 * k)));
    if (!lags_.empty() && lags_.back().steps == steps) continue;
    lags_.push_back({steps, Blocked(DisplacementHistogram(bins, std::ldexp(range, -k))), 0, 0, 0, {}, {}});
  }
}

void VanHove::accumulate(double time, std::span<const Vec3> unwrapped, double director) {
  for (Lag& lag : lags_) {
    const bool is_first = lag.x.empty();
    SHAKEN_CHECK(is_first || lag.x.size() == unwrapped.size(), "as many rods as before");
    if (!is_first) {
      if (++lag.passed < lag.steps) continue;
      std::vector<Vec2> displacements;
      displacements.reserve(unwrapped.size());
      for (std::size_t i = 0; i < unwrapped.size(); ++i) {
        const Vec2 way(unwrapped[i].x() - lag.x[i], unwrapped[i].y() - lag.y[i]);
        if (!way.hasNaN()) displacements.push_back(way);
      }
      lag.displacements.accumulate(lag.time, displacements, lag.director);
    }
    lag.passed = 0;
    lag.time = time;
    lag.director = director;
    lag.x.resize(unwrapped.size());
    lag.y.resize(unwrapped.size());
    for (std::size_t i = 0; i < unwrapped.size(); ++i) {
      lag.x[i] = unwrapped[i].x();
      lag.y[i] = unwrapped[i].y();
    }
  }
}

}  // namespace shaken::analysis
