// SPDX-License-Identifier: MIT
#include "analysis/temperatures.h"

#include <cmath>

#include "base/core/check.h"

namespace shaken::analysis {

Temperatures granular_temperatures(std::span<const Vec3> directors, std::span<const Vec3> velocities,
                                   std::span<const Vec3> angular_velocities, const RodInertia& inertia) {
  SHAKEN_CHECK(directors.size() == velocities.size() && directors.size() == angular_velocities.size(),
               "one velocity and one angular velocity for each director");
  const auto n_rods = static_cast<double>(directors.size());
  Vec3 mean = Vec3::Zero();
  for (const Vec3& velocity : velocities) mean += velocity / n_rods;
  double horizontal = 0, vertical = 0, along = 0, across = 0;  // sums of squared velocities
  double turning = 0, tipping = 0, spinning = 0, about_short_axes = 0, with_direction = 0;
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec3& n = directors[i];
    const Vec3& w = angular_velocities[i];
    const Vec3 v = velocities[i] - mean;
    horizontal += v.x() * v.x() + v.y() * v.y();
    vertical += v.z() * v.z();
    const double spin = w.dot(n);
    spinning += spin * spin;
    about_short_axes += (w - spin * n).squaredNorm();
    const double in_plane = std::hypot(n.x(), n.y());
    if (in_plane == 0.0) continue;
    with_direction += 1;
    const Vec3 u(n.x() / in_plane, n.y() / in_plane, 0), e(-u.y(), u.x(), 0), k = n.cross(e);
    const auto square = [](double component) { return component * component; };
    along += square(v.dot(u));
    across += square(v.dot(e));
    turning += square(w.dot(k));
    tipping += square(w.dot(e));
  }
  const double one = inertia.mass * n_rods / (n_rods - 1);  // of the mean square of one component of the velocity
  return {one * horizontal / n_rods / 2,
          one * vertical / n_rods,
          one * along / with_direction,
          one * across / with_direction,
          inertia.across * turning / with_direction,
          inertia.across * tipping / with_direction,
          inertia.along * spinning / n_rods,
          (inertia.across * about_short_axes + inertia.along * spinning) / n_rods / 3};
}

}  // namespace shaken::analysis
