// SPDX-License-Identifier: MIT
#include "sim/stepping/motion_change.h"

#include <algorithm>

namespace shaken {

MotionChange::MotionChange(const Vec3& velocity, const Vec3& precession, const Vec3& director, double rate_before,
                           double rate, double half_length, double earlier)
    : earlier_(static_cast<float>(earlier)) {
  const Vec3 tip = half_length * precession.cross(director);
  const double speed = velocity.norm();
  const double tip_speed = tip.norm();
  set_vector(velocity_, velocity);
  set_vector(tip_, tip);
  // floats carry 6e-8, and what is added to a bound is rounded again and again; earlier, the director was another
  const double turned = half_length * precession.norm() * std::max(rate, rate_before) * earlier;
  rounding_ = static_cast<float>(1e-4 + 1e-6 * (speed + tip_speed) + turned);
  all_round_ = rounding_ + static_cast<float>(speed + std::max(tip_speed, half_length * (rate - rate_before)));
  bending_ = static_cast<float>(0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before));
}

MotionChange MotionChange::unknown() {
  MotionChange change(Vec3::Zero(), Vec3::Zero(), Vec3::UnitX(), 0, 0, 0, 0);
  change.rounding_ = change.all_round_ = 1e30F;
  return change;
}

MotionBound motion_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow) {
  MotionBound bound;
  set_vector(bound.director, director);
  set_vector(bound.velocity, velocity);
  set_vector(bound.turning, flight.precession.cross(director));
  bound.half_rate2 = static_cast<float>(0.5 * flight.rate * flight.rate);
  bound.slow = std::max(std::abs(bound.velocity[0]), std::abs(bound.velocity[1])) < slow;
  return bound;
}

}  // namespace shaken
