// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/bounds/safe_time.h"
#include "sim/lanes/lanes.h"
#include "sim/motion/flight.h"

namespace shaken {

/// What the hits of one tick do to a rod, as far as bounds on its gaps are concerned: by how much faster than before
/// the gap to another rod may close.
///
/// Model:  hits change the velocity by dv and the director's rate of change by dw, so that no point of the rod comes
///         nearer along a direction d by more than (dv . d + h |dw . d|) t. What else the director does is the
///         curvature of its precession, at most q t^2 with q = h w^2 / 2; where w has grown by the hit at t', it is
///         q t'^2 + 2 q t' (t - t') + q' (t - t')^2 <= q t^2 + (q' - q)(t - t')^2, so (q' - q)(t - t') is added to the
///         speed.
class VelocityJump {
 public:
  VelocityJump() = default;
  /// The change of the velocity [mm/s], and of the precession of a rod with this director, whose rate was `rate_before`
  /// and is `rate` now [rad/s]. `displaced_for`: how long ago the hit may have been [s], where it displaced the rod.
  VelocityJump(const Vec3& velocity, const Vec3& precession, const Vec3& director, double rate_before, double rate,
               double half_length, double displaced_for);
  /// A jump of unknown size, after which every bound must be made anew.
  static VelocityJump unknown();

  /// The added speed along unit vectors from this rod to others, in every lane [mm/s].
  template <class F>
  SHAKEN_INLINE F along(const lanes::Vectors<F>& d) const {
    const F v = velocity_[0] * d.x + velocity_[1] * d.y + velocity_[2] * d.z;
    const F tip = tip_[0] * d.x + tip_[1] * d.y + tip_[2] * d.z;
    return rounding_ + v + lanes::abs(tip);
  }
  /// The added speed along any direction [mm/s].
  float any_direction() const { return any_direction_; }
  /// What the curvature of the precession adds to it, for each second that the bound is still to last [mm/s^2].
  float curvature() const { return curvature_; }
  /// How long the rod may have flown so already [s].
  float displaced_for() const { return displaced_for_; }

 private:
  float velocity_[3];
  float tip_[3];  ///< velocity of the rod's end relative to its centre [mm/s]
  float rounding_;
  float any_direction_;
  float curvature_;
  float displaced_for_;
};

// Inlined: the vectors that go in are there already (2 % of the time).
SHAKEN_INLINE VelocityJump::VelocityJump(const Vec3& velocity, const Vec3& precession, const Vec3& director,
                                         double rate_before, double rate, double half_length, double displaced_for)
    : curvature_(static_cast<float>(0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before))),
      displaced_for_(static_cast<float>(displaced_for)) {
  set_vector(velocity_, velocity);
  set_vector(tip_, half_length * precession.cross(director));
  const auto size = [](const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
  const float speed = size(velocity_);
  const float tip_speed = size(tip_);
  rounding_ = margins::kJumpSpeed + margins::kJump * (speed + tip_speed);
  // when the hit took place, the director was another one
  if (displaced_for > 0)
    rounding_ += static_cast<float>(half_length * precession.norm() * std::max(rate, rate_before) * displaced_for);
  const float faster = std::max(tip_speed, static_cast<float>(half_length * (rate - rate_before)));
  any_direction_ = rounding_ + (speed + faster) * (1.0F + margins::kJump);
}

/// How a rod flies at a tick; it is `slow` if it moves along x and y by less than that [mm/s].
FlightBound flight_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow);

}  // namespace shaken
