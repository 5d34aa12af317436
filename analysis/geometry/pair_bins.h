#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "analysis/geometry/region.h"
#include "base/core/types.h"

/// Distances of pairs in equal bins over [0, r_max), and how many of each a gas has.
namespace shaken::analysis {

/// Rods taken as the first of a pair in one sample, at most: of more, every k-th is, another set each time.
inline constexpr std::size_t kMaxReferences = 1024;
inline std::size_t reference_stride(std::size_t n) {
  return std::max<std::size_t>(1, (n + kMaxReferences - 1) / kMaxReferences);
}

/// Whether places up to `r_max` [mm] apart have one nearest image.
inline bool has_room(const Region& region, double r_max) {
  const Vec2 period = region.period();
  const auto is_wide = [&](double side) { return side == 0 || 2.0 * r_max <= side * (1.0 + 1e-12); };
  return is_wide(period.x()) && is_wide(period.y());
}

/// Bins of the distances from one place to others.
class PairBins {
 public:
  PairBins(std::size_t bins, double r_max, const Region& region)
      : region_(region),
        period_x_(or_endless(region.period().x())),
        period_y_(or_endless(region.period().y())),
        bins_per_mm_(static_cast<double>(bins) / r_max),
        too_far_(static_cast<int>(bins)) {}

  /// `bins` (n) gets the bin of each place (xs, ys) (n), wrapped into the box [mm], seen from (x, y): one past the last
  /// for what is too far, or out of sight.
  void find(double x, double y, std::span<const double> xs, std::span<const double> ys, std::vector<int>& bins) const {
    const std::size_t n = xs.size();
    const double period_x = period_x_, period_y = period_y_;
    for (std::size_t j = 0; j < n; ++j) {  // without branches: it becomes vector instructions
      const double dx = std::abs(x - xs[j]), dy = std::abs(y - ys[j]);
      const double to_x = std::min(dx, period_x - dx), to_y = std::min(dy, period_y - dy);
      bins[j] = std::min(static_cast<int>(std::sqrt(to_x * to_x + to_y * to_y) * bins_per_mm_), too_far_);
    }
    if (!(region_.hidden_radius() > 0)) return;
    for (std::size_t j = 0; j < n; ++j) {
      if (!region_.in_sight({x, y}, {xs[j], ys[j]})) bins[j] = too_far_;
    }
  }

 private:
  /// Where walls stand no image is nearer.
  static double or_endless(double period) { return period > 0 ? period : std::numeric_limits<double>::infinity(); }

  const Region& region_;
  double period_x_, period_y_;
  double bins_per_mm_;
  int too_far_;
};

/// Adds what a gas of `density` [1/mm^2] has in the rings about a place, of those that are in its sight.
inline void add_gas(std::span<double> expected, double r_max, const Vec2& place, const Region& region, double density) {
  double within = 0;
  for (std::size_t bin = 0; bin < expected.size(); ++bin) {
    const double radius = r_max * static_cast<double>(bin + 1) / static_cast<double>(expected.size());
    const double area = region.area_in_sight(place, radius);
    expected[bin] += density * (area - within);
    within = area;
  }
}

}  // namespace shaken::analysis
