// SPDX-License-Identifier: MIT
#include "sim/stepping/motion_drift.h"

#include <algorithm>
#include <cmath>

namespace shaken {
namespace {

/// The limit for a rod's precession, from what it is at the restart.
constexpr double kRateFactor = 1.2;
constexpr double kRateMore = 10;  ///< [rad/s]

bool is_within(const float* drift, float across, float along_z) {
  constexpr float kKept = 0.998F;  // for rounding: the drift is a sum of many floats
  return across > 0 && along_z > 0 && drift[0] * drift[0] + drift[1] * drift[1] <= kKept * across * across &&
         std::abs(drift[2]) <= kKept * along_z;
}

}  // namespace

void MotionDrift::restart(const Flight& flight) {
  std::fill_n(velocity_, 3, 0.0F);
  std::fill_n(turning_, 3, 0.0F);
  turning_error_ = 0;
  rate_limit_ = static_cast<float>(kRateFactor * flight.rate + kRateMore);
}

bool MotionDrift::is_tolerated(const Flight& flight) const {
  return flight.rate <= static_cast<double>(rate_limit_) &&
         is_within(velocity_, kMotionTolerance.velocity_xy, kMotionTolerance.velocity_z) &&
         is_within(turning_, kMotionTolerance.turning_xy - turning_error_, kMotionTolerance.turning_z - turning_error_);
}

MotionBound MotionDrift::bound(const Flight& flight, const Vec3& velocity, const Vec3& director) const {
  MotionBound bound;
  set_vector(bound.director, director);
  set_vector(bound.velocity, velocity);
  set_vector(bound.turning, flight.precession.cross(director));
  bound.half_rate2 = static_cast<float>(0.5 * flight.rate * flight.rate);
  for (int c = 0; c < 3; ++c) {
    bound.velocity_centre[c] = bound.velocity[c] - velocity_[c];
    bound.turning_centre[c] = bound.turning[c] - turning_[c];
  }
  bound.limit_half_rate2 = 0.5F * rate_limit_ * rate_limit_;
  return bound;
}

}  // namespace shaken
