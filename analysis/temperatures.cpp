#include "analysis/temperatures.h"

#include <cmath>

#include "base/core/check.h"

namespace shaken::analysis {

Temperatures granular_temperatures(std::span<const Vec3> directors, std::span<const Vec3> velocities,
                                   std::span<const Vec3> angular_velocities, std::span<const RodInertia> inertias) {
  SHAKEN_CHECK(directors.size() == velocities.size() && directors.size() == angular_velocities.size(),
               "one velocity and one angular velocity for each director");
  SHAKEN_CHECK(inertias.size() == 1 || inertias.size() == directors.size(), "one inertia, or that of each rod");
  // Sums are in units of the first rod's, so that those of equal rods have no factors.
  const RodInertia& first = inertias.front();
  const auto mass_of = [&](std::size_t i) { return inertias.size() == 1 ? 1.0 : inertias[i].mass / first.mass; };
  const auto n_rods = static_cast<double>(directors.size());
  double mass = 0;
  for (std::size_t i = 0; i < directors.size(); ++i) mass += mass_of(i);
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < directors.size(); ++i) mean += mass_of(i) * velocities[i] / mass;
  double horizontal = 0, vertical = 0, along = 0, across = 0;  // sums of squared velocities, times mass or inertia
  double turning = 0, tipping = 0, spinning = 0, about_short_axes = 0, with_direction = 0;
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec3& n = directors[i];
    const Vec3& w = angular_velocities[i];
    const Vec3 v = velocities[i] - mean;
    const RodInertia& inertia = inertias[inertias.size() == 1 ? 0 : i];
    const double m = mass_of(i), of_across = inertia.across / first.across, of_along = inertia.along / first.along;
    horizontal += m * (v.x() * v.x() + v.y() * v.y());
    vertical += m * (v.z() * v.z());
    const double spin = w.dot(n);
    spinning += of_along * (spin * spin);
    about_short_axes += of_across * (w - spin * n).squaredNorm();
    const double in_plane = std::hypot(n.x(), n.y());
    if (in_plane == 0.0) continue;
    with_direction += 1;
    const Vec3 u(n.x() / in_plane, n.y() / in_plane, 0), e(-u.y(), u.x(), 0), k = n.cross(e);
    const auto square = [](double component) { return component * component; };
    along += m * square(v.dot(u));
    across += m * square(v.dot(e));
    turning += of_across * square(w.dot(k));
    tipping += of_across * square(w.dot(e));
  }
  const double one = first.mass * n_rods / (n_rods - 1);  // of the mean square of one component of the velocity
  return {one * horizontal / n_rods / 2,
          one * vertical / n_rods,
          one * along / with_direction,
          one * across / with_direction,
          first.across * turning / with_direction,
          first.across * tipping / with_direction,
          first.along * spinning / n_rods,
          (first.across * about_short_axes + first.along * spinning) / n_rods / 3};
}

void TemperatureStatistics::accumulate(const Temperatures& sample, std::span<const Vec3> velocities) {
  ++samples_;
  for (std::size_t k = 0; k < kFreedoms; ++k) sums_[k] += sample[k];
  double squares = 0, speeds = 0;
  for (const Vec3& velocity : velocities) {
    const double square = velocity.head<2>().squaredNorm();
    squares += square;
    speeds += std::sqrt(square);
  }
  squares_ += squares / static_cast<double>(velocities.size());
  speeds_ += speeds / static_cast<double>(velocities.size());
}

Speeds TemperatureStatistics::speeds() const {
  const auto samples = static_cast<double>(samples_);
  return {.rms = std::sqrt(squares_ / samples), .mean = speeds_ / samples};
}

}  // namespace shaken::analysis
