#pragma once

#include <array>
#include <cmath>

#include "base/core/types.h"

namespace shaken::run {

/// The shortest rotation that turns z into the unit vector n, as (w, x, y, z); about x for n = -z.
inline std::array<double, 4> quaternion_of_director(const Vec3& n) {
  const double across2 = n.x() * n.x() + n.y() * n.y();
  // 1 + n_z without cancellation near n = -z.
  const double w2 = n.z() > 0 ? 1.0 + n.z() : across2 / (1.0 - n.z());
  const double norm = std::sqrt(w2 * w2 + across2);
  if (norm == 0) return {0, 1, 0, 0};
  return {w2 / norm, -n.y() / norm, n.x() / norm, 0.0};
}

/// Where a quaternion, of any length but 0, turns z.
inline Vec3 director_of_quaternion(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return Vec3(2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z).normalized();
}

}  // namespace shaken::run
