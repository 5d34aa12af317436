#include "analysis/number_fluctuations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/errors/estimate_curve.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

constexpr std::array kDivisions{2, 3, 4, 5, 6, 8, 10, 12, 16, 20};
constexpr double kFitTo = 0.25;  // of the area

/// Slope of a straight line through the points that are finite, weighted; NaN with fewer than three.
double slope(std::span<const double> x, std::span<const double> y, std::span<const double> weight) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    w += weight[i];
    wx += weight[i] * x[i];
    wy += weight[i] * y[i];
    wxx += weight[i] * x[i] * x[i];
    wxy += weight[i] * x[i] * y[i];
    ++n;
  }
  return n < NumberFluctuations::kMinSizes ? kNaN : (w * wxy - wx * wy) / (w * wxx - wx * wx);
}

}  // namespace

NumberFluctuations::NumberFluctuations(const Box& box, double area, double fit_from, const Where& counts)
    : box_(box), fit_from_(fit_from) {
  SHAKEN_CHECK(box.shorter() > 0 && area > 0, "a box without room");
  std::size_t n_boxes = 0;
  for (const int m : kDivisions) {
    const Vec2 sides = box.sides() / m;
    Size size{m, sides.prod() / area, {}, n_boxes, 0};
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < m; ++i) {
        const bool here = !counts || counts(sides.cwiseProduct(Vec2(i + 0.5, j + 0.5)), sides);
        size.place.push_back(here ? static_cast<std::int32_t>(size.n_boxes++) : -1);
      }
    }
    n_boxes += size.n_boxes;
    if (size.n_boxes > 0) sizes_.push_back(std::move(size));
  }
  sums_.resize(n_boxes);
  squares_.resize(n_boxes);
}

void NumberFluctuations::accumulate(std::span<const Vec3> positions) {
  std::vector<Vec2> places;  // in [0, 1) of the box
  places.reserve(positions.size());
  for (const Vec3& position : positions) {
    const Vec2 place = position.head<2>().cwiseQuotient(box_.sides());
    if (!place.allFinite()) continue;
    places.emplace_back(place.x() - std::floor(place.x()), place.y() - std::floor(place.y()));
  }
  std::vector<std::int64_t> n;
  for (const Size& size : sizes_) {
    const int m = size.divisions;
    n.assign(size.n_boxes, 0);
    for (const Vec2& place : places) {
      const int i = std::min(static_cast<int>(place.x() * m), m - 1);
      const int j = std::min(static_cast<int>(place.y() * m), m - 1);
      const std::int32_t box = size.place[static_cast<std::size_t>(j * m + i)];
      if (box >= 0) ++n[static_cast<std::size_t>(box)];
    }
    for (std::size_t box = 0; box < n.size(); ++box) {
      sums_[size.first + box] += n[box];
      squares_[size.first + box] += n[box] * n[box];
    }
  }
  ++samples_;
}

NumberFluctuations::Moments NumberFluctuations::moments(const Size& size) const {
  if (samples_ == 0) return {kNaN, kNaN, kNaN};
  const auto samples = static_cast<double>(samples_);
  const auto boxes = static_cast<double>(size.n_boxes);
  double mean = 0, square = 0, within = 0;
  for (std::size_t box = size.first; box < size.first + size.n_boxes; ++box) {
    const double n = static_cast<double>(sums_[box]) / samples;
    const double n2 = static_cast<double>(squares_[box]) / samples;
    mean += n / boxes;
    square += n2 / boxes;
    within += (n2 - n * n) / boxes;
  }
  // Differences of rounded numbers can come out a hair below zero.
  const double without_map = samples_ < 2 ? kNaN : std::max(0.0, within) * samples / (samples - 1);
  return {mean, std::max(0.0, square - mean * mean), without_map};
}

bool NumberFluctuations::is_fitted(const Size& size) const {
  return box_.shorter() / size.divisions >= fit_from_ * (1 - 1e-9) && size.area_fraction <= kFitTo * (1 + 1e-9);
}

/// Mean and both spreads of each size, then the two exponents.
std::vector<double> NumberFluctuations::numbers() const {
  std::vector<double> result;
  std::vector<double> log_n, log_std, log_std_without_map, weight;
  for (const Size& size : sizes_) {
    const Moments m = moments(size);
    result.insert(result.end(), {m.mean, std::sqrt(m.variance), std::sqrt(m.variance_without_map)});
    if (!is_fitted(size)) continue;
    const double rest = 1 - size.area_fraction;
    log_n.push_back(std::log(m.mean));
    log_std.push_back(0.5 * std::log(m.variance / rest));
    log_std_without_map.push_back(0.5 * std::log(m.variance_without_map / rest));
    weight.push_back(static_cast<double>(size.n_boxes));
  }
  result.push_back(slope(log_n, log_std, weight));
  result.push_back(slope(log_n, log_std_without_map, weight));
  return result;
}

NumberFluctuationCurve NumberFluctuations::reduce(const Blocked<NumberFluctuations>& blocks, double t_steady) {
  const NumberFluctuations& empty = blocks.empty();
  const std::vector<Estimate> estimates = jackknife(empty, blocks.parts_after(t_steady, kMostParts),
                                                    [](const NumberFluctuations& part) { return part.numbers(); });
  NumberFluctuationCurve curve;
  for (std::size_t k = 0; k < empty.sizes_.size(); ++k) {
    curve.area_fraction.push_back(empty.sizes_[k].area_fraction);
    curve.mean_n.push_back(estimates[3 * k].value);
    curve.std_n.push_back(estimates[3 * k + 1]);
    curve.std_n_without_map.push_back(estimates[3 * k + 2]);
  }
  curve.fitted = static_cast<std::size_t>(
      std::count_if(empty.sizes_.begin(), empty.sizes_.end(), [&](const Size& size) { return empty.is_fitted(size); }));
  curve.exponent = estimates[estimates.size() - 2];
  curve.exponent_without_map = estimates.back();
  return curve;
}

}  // namespace shaken::analysis
