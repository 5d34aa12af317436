#include "analysis/polar_order.h"

#include <cmath>
#include <cstddef>

#include "base/core/check.h"

namespace shaken::analysis {

PolarOrder polar_order(std::span<const Vec3> directors) {
  double x = 0, y = 0, n = 0;
  for (const Vec3& director : directors) {
    const double in_plane = std::hypot(director.x(), director.y());
    if (in_plane == 0.0) continue;
    x += director.x() / in_plane;
    y += director.y() / in_plane;
    n += 1;
  }
  if (n == 0) return {};
  return {std::hypot(x, y) / n, std::atan2(y, x)};
}

void PolarSeries::accumulate(double time, const PolarOrder& sample) {
  series_.accumulate(
      time, {sample.order, sample.order * std::cos(sample.direction), sample.order * std::sin(sample.direction)});
}

std::vector<double> PolarSeries::directions() const {
  std::vector<double> angles;
  angles.reserve(times().size());
  for (std::size_t i = 0; i < times().size(); ++i) {
    angles.push_back(std::atan2(series_.column(2)[i], series_.column(1)[i]));
  }
  return angles;
}

void PolarStatistics::accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities,
                                 const PolarOrder& order) {
  SHAKEN_CHECK(directors.size() == velocities.size(), "one velocity for each director");
  spread_.accumulate(order.order);
  double x = 0, y = 0, speeds = 0;
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec3& n = directors[i];
    const Vec3& v = velocities[i];
    x += v.x();
    y += v.y();
    speeds += std::hypot(v.x(), v.y());
    const double in_plane = std::hypot(n.x(), n.y());
    if (in_plane == 0.0) continue;
    const double along = (v.x() * n.x() + v.y() * n.y()) / in_plane;
    const double across = (v.y() * n.x() - v.x() * n.y()) / in_plane;
    ++rods_;
    forward_ += along;
    along_ += along * along;
    across_ += across * across;
  }
  if (speeds == 0.0) return;
  ++moving_;
  flight_ += std::hypot(x, y) / speeds;
}

PolarNumbers PolarStatistics::reduce() const {
  const auto rods = static_cast<double>(rods_);
  return {.order = spread_.samples > 0 ? spread_.mean : std::nan(""),
          .variance = spread_.variance(),
          .forward = forward_ / rods,
          .along_rms = std::sqrt(along_ / rods),
          .across_rms = std::sqrt(across_ / rods),
          .velocity_polarity = flight_ / static_cast<double>(moving_)};
}

}  // namespace shaken::analysis
