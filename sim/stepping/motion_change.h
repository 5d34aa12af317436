// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/contact/safe_time.h"
#include "sim/lanes/lanes.h"
#include "sim/motion/flight.h"

namespace shaken {

/// By how much faster the gap to another rod may close, for the hits of one tick, than a bound allows that was made
/// before.
///
/// Model:  hits change the velocity by dv and the director's rate of change by dw, so that no point of the rod comes
///         nearer along a direction d by more than (dv . d + h |dw . d|) t. What else the director does is the
///         curvature of its precession, at most half_rate2 t^2; where that has grown, the difference is added.
class MotionChange {
 public:
  MotionChange() = default;
  /// Of the velocity [mm/s], and of the precession of a rod with this director, that had the rate `rate_before` and has
  /// `rate` now [rad/s]; up to `earlier` ago [s].
  MotionChange(const Vec3& velocity, const Vec3& precession, const Vec3& director, double rate_before, double rate,
               double half_length, double earlier);
  /// Such that every bound must be made anew.
  static MotionChange unknown();

  /// Speed along unit vectors from this rod to others, in every lane [mm/s].
  template <class F>
  SHAKEN_INLINE F along(const lanes::Vectors<F>& d) const {
    const F v = velocity_[0] * d.x + velocity_[1] * d.y + velocity_[2] * d.z;
    const F tip = tip_[0] * d.x + tip_[1] * d.y + tip_[2] * d.z;
    return rounding_ + v + lanes::abs(tip);
  }
  /// The same along whatever direction [mm/s].
  float all_round() const { return all_round_; }
  /// And what the precession adds to it, for each second that the bound is still to last [mm/s^2].
  float bending() const { return bending_; }
  /// Since when it may have been so [s].
  float earlier() const { return earlier_; }

 private:
  float velocity_[3];
  float tip_[3];  ///< velocity of the rod's end relative to its centre [mm/s]
  float rounding_;
  float all_round_;
  float bending_;
  float earlier_;
};

// Inlined: the vectors that go in are there already (2 % of the time).
SHAKEN_INLINE MotionChange::MotionChange(const Vec3& velocity, const Vec3& precession, const Vec3& director,
                                         double rate_before, double rate, double half_length, double earlier)
    : bending_(static_cast<float>(0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before))),
      earlier_(static_cast<float>(earlier)) {
  set_vector(velocity_, velocity);
  set_vector(tip_, half_length * precession.cross(director));
  const auto size = [](const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
  const float speed = size(velocity_);
  const float tip_speed = size(tip_);
  // floats carry 6e-8, and what is added to a bound is rounded again and again
  rounding_ = 1e-4F + 1e-6F * (speed + tip_speed);
  // earlier, the director was another
  if (earlier > 0)
    rounding_ += static_cast<float>(half_length * precession.norm() * std::max(rate, rate_before) * earlier);
  const float faster = std::max(tip_speed, static_cast<float>(half_length * (rate - rate_before)));
  all_round_ = rounding_ + (speed + faster) * (1.0F + 1e-6F);
}

/// How a rod flies at a tick; it is `slow` if it moves along x and y by less than that [mm/s].
MotionBound motion_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow);

}  // namespace shaken
