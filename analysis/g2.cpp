// SPDX-License-Identifier: MIT
#include "analysis/g2.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Rods taken as the first of a pair in one sample, at most.
constexpr std::size_t kMaxReferencesOfG2 = 1024;

}  // namespace

OrientationCorrelation::OrientationCorrelation(int bins, double r_max)
    : r_max_(r_max),
      pairs_(static_cast<std::size_t>(std::max(bins, 0))),
      sums_(pairs_.size()),
      expected_(pairs_.size()) {
  SHAKEN_CHECK(bins >= 1 && r_max > 0.0, "bins and range must not be empty");
}

void OrientationCorrelation::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors,
                                        const Region& region) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  const Box& box = region.box();
  const auto has_room = [&](double period) { return period == 0 || 2.0 * r_max_ <= period * (1.0 + 1e-12); };
  SHAKEN_CHECK(has_room(region.period().x()) && has_room(region.period().y()),
               "distances beyond half the box have no nearest image");
  std::vector<double> xs, ys, cs, ss;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    if (angle == Vec2::Zero()) continue;
    xs.push_back(wrapped(positions[i].x(), box.x()));
    ys.push_back(wrapped(positions[i].y(), box.y()));
    cs.push_back(angle.x());
    ss.push_back(angle.y());
  }
  const std::size_t n = xs.size();
  const double bins_per_mm = static_cast<double>(pairs_.size()) / r_max_;
  const std::size_t stride = std::max<std::size_t>(1, (n + kMaxReferencesOfG2 - 1) / kMaxReferencesOfG2);
  // Where walls stand no image is nearer.
  const auto or_endless = [](double side) { return side > 0 ? side : std::numeric_limits<double>::infinity(); };
  const double period_x = or_endless(region.period().x()), period_y = or_endless(region.period().y());
  // In two passes, the first without branches: it becomes vector instructions. What is too far goes into a bin of its
  // own.
  const auto too_far = static_cast<int>(pairs_.size());
  std::vector<int> bins(n);
  std::vector<double> values(n), sums(pairs_.size() + 1);
  std::vector<std::int64_t> pairs(pairs_.size() + 1);
  const double others = n > 0 ? static_cast<double>(n - 1) : 0.0;  // that a rod can make pairs with
  double references = 0;
  for (std::size_t i = static_cast<std::size_t>(calls_) % stride; i < n; i += stride) {
    references += 1;
    const double xi = xs[i], yi = ys[i], ci = cs[i], si = ss[i];
    for (std::size_t j = 0; j < n; ++j) {
      const double dx = std::abs(xi - xs[j]), dy = std::abs(yi - ys[j]);
      const double x = std::min(dx, period_x - dx), y = std::min(dy, period_y - dy);
      bins[j] = std::min(static_cast<int>(std::sqrt(x * x + y * y) * bins_per_mm), too_far);
      values[j] = ci * cs[j] + si * ss[j];
    }
    if (region.hidden_radius() > 0) {
      for (std::size_t j = 0; j < n; ++j) {
        if (!region.in_sight({xi, yi}, {xs[j], ys[j]})) bins[j] = too_far;
      }
    }
    bins[i] = too_far;
    for (std::size_t j = 0; j < n; ++j) {
      const auto bin = static_cast<std::size_t>(bins[j]);
      ++pairs[bin];
      sums[bin] += values[j];
    }
    if (region.has_walls()) expect({xi, yi}, region, others / region.area());
  }
  // In a periodic box every place sees the same.
  if (!region.has_walls()) expect(Vec2::Zero(), region, references * others / region.area());
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    pairs_[bin] += pairs[bin];
    sums_[bin] += sums[bin];
  }
  ++calls_;
}

/// Adds what a gas of `density` [1/mm^2] has in the rings about a place.
void OrientationCorrelation::expect(const Vec2& place, const Region& region, double density) {
  double within = 0;
  for (std::size_t bin = 0; bin < expected_.size(); ++bin) {
    const double radius = r_max_ * static_cast<double>(bin + 1) / static_cast<double>(expected_.size());
    const double area = region.area_in_sight(place, radius);
    expected_[bin] += density * (area - within);
    within = area;
  }
}

OrientationCurve OrientationCorrelation::reduce() const {
  const double width = r_max_ / static_cast<double>(pairs_.size());
  OrientationCurve curve;
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    curve.r.push_back((static_cast<double>(bin) + 0.5) * width);
    curve.g2.push_back(pairs_[bin] > 0 ? sums_[bin] / static_cast<double>(pairs_[bin])
                                       : std::numeric_limits<double>::quiet_NaN());
    curve.g.push_back(expected_[bin] > 0 ? static_cast<double>(pairs_[bin]) / expected_[bin]
                                         : std::numeric_limits<double>::quiet_NaN());
  }
  return curve;
}

}  // namespace shaken::analysis
