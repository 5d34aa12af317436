// SPDX-License-Identifier: MIT
#include "analysis/g2.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/fold.h"
#include "sim/core/check.h"

namespace shaken::analysis {
namespace {

/// Rods taken as the first of a pair in one sample, at most.
constexpr std::size_t kMaxReferences = 1024;

}  // namespace

OrientationCorrelation::OrientationCorrelation(int bins, double r_max)
    : r_max_(r_max), pairs_(static_cast<std::size_t>(std::max(bins, 0))), sums_(pairs_.size()) {
  SHAKEN_CHECK(bins >= 1 && r_max > 0.0, "bins and range must not be empty");
}

void OrientationCorrelation::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors,
                                        double box_side) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  SHAKEN_CHECK(2.0 * r_max_ <= box_side * (1.0 + 1e-12), "distances beyond half the box have no nearest image");
  struct Rod {
    double x, y, c, s;
  };
  std::vector<Rod> rods;
  rods.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    if (angle == Vec2::Zero()) continue;
    const double x = positions[i].x() - box_side * std::floor(positions[i].x() / box_side);
    const double y = positions[i].y() - box_side * std::floor(positions[i].y() / box_side);
    rods.push_back({x, y, angle.x(), angle.y()});
  }
  const double bins_per_mm = static_cast<double>(pairs_.size()) / r_max_;
  const std::size_t stride = std::max<std::size_t>(1, (rods.size() + kMaxReferences - 1) / kMaxReferences);
  for (std::size_t i = static_cast<std::size_t>(calls_) % stride; i < rods.size(); i += stride) {
    const Rod a = rods[i];
    expected_per_area_ += static_cast<double>(rods.size()) / (box_side * box_side);
    for (std::size_t j = 0; j < rods.size(); ++j) {
      const Rod& b = rods[j];
      const double dx = std::abs(a.x - b.x);
      const double dy = std::abs(a.y - b.y);
      const double x = std::min(dx, box_side - dx);
      const double y = std::min(dy, box_side - dy);
      const double r2 = x * x + y * y;
      if (r2 >= r_max_ * r_max_ || i == j) continue;
      const std::size_t bin = std::min(static_cast<std::size_t>(std::sqrt(r2) * bins_per_mm), pairs_.size() - 1);
      ++pairs_[bin];
      sums_[bin] += a.c * b.c + a.s * b.s;
    }
  }
  ++calls_;
}

OrientationCurve OrientationCorrelation::reduce() const {
  const double width = r_max_ / static_cast<double>(pairs_.size());
  OrientationCurve curve;
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    curve.r.push_back((static_cast<double>(bin) + 0.5) * width);
    curve.g2.push_back(pairs_[bin] > 0 ? sums_[bin] / static_cast<double>(pairs_[bin])
                                       : std::numeric_limits<double>::quiet_NaN());
    const double ring = kPi * width * width * (2.0 * static_cast<double>(bin) + 1.0);
    curve.g.push_back(expected_per_area_ > 0 ? static_cast<double>(pairs_[bin]) / (expected_per_area_ * ring)
                                             : std::numeric_limits<double>::quiet_NaN());
  }
  return curve;
}

void OrientationCorrelation::reset() {
  calls_ = 0;
  std::fill(pairs_.begin(), pairs_.end(), 0);
  std::fill(sums_.begin(), sums_.end(), 0.0);
  expected_per_area_ = 0;
}

void OrientationCorrelation::merge(const OrientationCorrelation& other) {
  SHAKEN_CHECK(pairs_.size() == other.pairs_.size() && r_max_ == other.r_max_, "correlations of different bins");
  calls_ += other.calls_;
  expected_per_area_ += other.expected_per_area_;
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    pairs_[bin] += other.pairs_[bin];
    sums_[bin] += other.sums_[bin];
  }
}

void OrientationCorrelation::save(StateWriter& writer) const {
  writer.tag("OrientationCorrelation");
  writer.put(r_max_);
  writer.put(calls_);
  writer.put(expected_per_area_);
  writer.put(pairs_);
  writer.put(sums_);
}

void OrientationCorrelation::restore(StateReader& reader) {
  reader.tag("OrientationCorrelation");
  if (reader.real() != r_max_) throw StateError("saved analysis state: OrientationCorrelation of another range");
  const std::int64_t calls = reader.integer(0, std::numeric_limits<std::int64_t>::max() / 2);
  const double expected_per_area = reader.real();
  std::vector<std::int64_t> pairs = reader.integers(pairs_.size());
  sums_ = reader.reals(sums_.size());
  pairs_ = std::move(pairs);
  expected_per_area_ = expected_per_area;
  calls_ = calls;
}

}  // namespace shaken::analysis
