#include "sim/bounds/velocity_jump.h"

#include <algorithm>

namespace shaken {

VelocityJump VelocityJump::unknown() {
  VelocityJump change(Vec3::Zero(), Vec3::Zero(), 0, 0, 0);
  change.rounding_ = change.any_direction_ = 1e30F;
  return change;
}

void VelocityJump::displace(const Vec3& position, const Vec3& director, double half_length) {
  has_displaced_ = true;
  set_vector(shift_, position);
  set_vector(tip_shift_, half_length * director);
  shift_rounding_ = margins::kJump * (size(shift_) + size(tip_shift_));
}

FlightBound flight_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow_speed) {
  FlightBound bound;
  set_vector(bound.director, director);
  set_velocity(bound, velocity);
  set_vector(bound.turning, flight.precession.cross(director));
  bound.half_rate2 = static_cast<float>(0.5 * flight.rate * flight.rate);
  bound.slow = std::max(std::abs(bound.velocity[0]), std::abs(bound.velocity[1])) < slow_speed;
  return bound;
}

}  // namespace shaken
