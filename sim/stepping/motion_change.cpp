// SPDX-License-Identifier: MIT
#include "sim/stepping/motion_change.h"

#include <algorithm>

namespace shaken {

MotionChange MotionChange::unknown() {
  MotionChange change(Vec3::Zero(), Vec3::Zero(), Vec3::UnitX(), 0, 0, 0, 0);
  change.rounding_ = change.all_round_ = 1e30F;
  return change;
}

MotionBound motion_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow) {
  MotionBound bound;
  set_vector(bound.director, director);
  set_velocity(bound, velocity);
  set_vector(bound.turning, flight.precession.cross(director));
  bound.half_rate2 = static_cast<float>(0.5 * flight.rate * flight.rate);
  bound.slow = std::max(std::abs(bound.velocity[0]), std::abs(bound.velocity[1])) < slow;
  return bound;
}

}  // namespace shaken
