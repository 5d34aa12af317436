#include "analysis/flow_correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/bins.h"
#include "analysis/lags/lag_fits.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Rods taken as the first of a pair in one sample, at most.
constexpr std::size_t kMaxReferencesOfFlow = 1024;

}  // namespace

FlowSums::FlowSums(int bins, double r_max, double near_distance)
    : r_max_(r_max),
      near_distance_(near_distance),
      pairs_(static_cast<std::size_t>(std::max(bins, 0))),
      along_(pairs_.size()),
      across_(pairs_.size()) {
  SHAKEN_CHECK(bins >= 1 && r_max > 0.0, "bins and range must not be empty");
}

void FlowSums::accumulate(std::span<const Vec2> places, std::span<const Vec2> velocities, double director,
                          const Region& region) {
  SHAKEN_CHECK(places.size() == velocities.size(), "one velocity for each place");
  const std::size_t n = places.size();
  const double c = std::cos(director), s = std::sin(director);
  std::vector<double> xs(n), ys(n), along(n), across(n), squares(n);
  for (std::size_t i = 0; i < n; ++i) {
    xs[i] = places[i].x();
    ys[i] = places[i].y();
    along[i] = c * velocities[i].x() + s * velocities[i].y();
    across[i] = c * velocities[i].y() - s * velocities[i].x();
    along_squares_ += along[i] * along[i];
    across_squares_ += across[i] * across[i];
  }
  rods_ += static_cast<std::int64_t>(n);
  const double bins_per_mm = static_cast<double>(pairs_.size()) / r_max_;
  const double farthest = std::max(r_max_, near_distance_);
  // Where walls stand no image is nearer.
  const auto or_endless = [](double side) { return side > 0 ? side : std::numeric_limits<double>::infinity(); };
  const double period_x = or_endless(region.period().x()), period_y = or_endless(region.period().y());
  const std::size_t stride = std::max<std::size_t>(1, (n + kMaxReferencesOfFlow - 1) / kMaxReferencesOfFlow);
  for (std::size_t i = static_cast<std::size_t>(calls_) % stride; i < n; i += stride) {
    // A pass by itself, without branches: it becomes vector instructions.
    const double xi = xs[i], yi = ys[i];
    for (std::size_t j = 0; j < n; ++j) {
      const double dx = std::abs(xi - xs[j]), dy = std::abs(yi - ys[j]);
      const double x = std::min(dx, period_x - dx), y = std::min(dy, period_y - dy);
      squares[j] = x * x + y * y;
    }
    for (std::size_t j = 0; j < n; ++j) {
      if (squares[j] >= farthest * farthest || j == i) continue;
      if (region.hidden_radius() > 0 && !region.in_sight(places[i], places[j])) continue;
      const double distance = std::sqrt(squares[j]), product = along[i] * along[j], other = across[i] * across[j];
      if (distance < near_distance_) {
        ++near_pairs_;
        near_ += product + other;
      }
      const auto bin = static_cast<std::size_t>(distance * bins_per_mm);
      if (bin >= pairs_.size()) continue;
      ++pairs_[bin];
      along_[bin] += product;
      across_[bin] += other;
    }
  }
  ++calls_;
}

FlowCurve FlowSums::reduce() const {
  const double width = r_max_ / static_cast<double>(pairs_.size()), rods = static_cast<double>(rods_);
  const double along_square = along_squares_ / rods, across_square = across_squares_ / rods;
  const double square = along_square + across_square;
  FlowCurve curve;
  curve.r = middles_of_bins(pairs_.size(), width);
  EstimateCurve met;  // without bins that no pair is in
  std::vector<double> met_at;
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    const auto pairs = static_cast<double>(pairs_[bin]);
    curve.c.push_back((along_[bin] + across_[bin]) / pairs / square);
    curve.along.push_back(along_[bin] / pairs / along_square);
    curve.across.push_back(across_[bin] / pairs / across_square);
    if (!std::isfinite(curve.c.back())) continue;
    met_at.push_back(curve.r[bin]);
    met.push_back(Estimate{curve.c.back()});
  }
  curve.near = near_ / static_cast<double>(near_pairs_) / square;
  curve.length = decay_time(met_at, met).value;
  return curve;
}

FlowCorrelation::FlowCorrelation(int bins, double r_max, double near_distance)
    : sums_(FlowSums(bins, r_max, near_distance)) {}

void FlowCorrelation::accumulate(double time, std::span<const Vec3> positions, std::span<const Vec3> unwrapped,
                                 double director, const Region& region) {
  SHAKEN_CHECK(positions.size() == unwrapped.size(), "every centre both ways");
  if (!x_.empty()) {
    SHAKEN_CHECK(x_.size() == unwrapped.size() && time > time_, "as many rods as before, later");
    std::vector<Vec2> places, velocities;
    places.reserve(x_.size());
    velocities.reserve(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) {
      places.emplace_back(x_[i], y_[i]);
      const Vec2 way(unwrapped[i].x() - unwrapped_x_[i], unwrapped[i].y() - unwrapped_y_[i]);
      velocities.emplace_back(way / (time - time_));
    }
    sums_.accumulate(time_, places, velocities, director_, region);
  }
  time_ = time;
  director_ = director;
  for (std::vector<double>* column : {&x_, &y_, &unwrapped_x_, &unwrapped_y_}) column->resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    x_[i] = positions[i].x();
    y_[i] = positions[i].y();
    unwrapped_x_[i] = unwrapped[i].x();
    unwrapped_y_[i] = unwrapped[i].y();
  }
}

}  // namespace shaken::analysis
