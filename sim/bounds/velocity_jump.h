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
///         speed. Hits that displace the rod, by dx and the director by dn, bring it nearer by dx . d + h |dn . d|.
class VelocityJump {
 public:
  VelocityJump() = default;
  /// By how much the velocity [mm/s] and the director's rate of change, `turning` [1/s], have changed; the rate of
  /// precession was `rate_before` and is `rate` now [rad/s]. half_length: of the rod [mm].
  VelocityJump(const Vec3& velocity, const Vec3& turning, double rate_before, double rate, double half_length);
  /// A jump of unknown size, after which every bound must be made anew.
  static VelocityJump unknown();
  /// Adds that the rod was displaced by `position` [mm], and its director, a unit vector, by `director`.
  void displace(const Vec3& position, const Vec3& director, double half_length);

  /// The added speed along unit vectors from this rod to others, in every lane [mm/s].
  template <class F>
  SHAKEN_INLINE F along(const lanes::Vectors<F>& d) const {
    return rounding_ + nearer(velocity_, tip_, d);
  }
  /// The added speed along any direction [mm/s].
  float any_direction() const { return any_direction_; }
  /// What the curvature of the precession adds to it, for each second that the bound is still to last [mm/s^2].
  float curvature() const { return curvature_; }
  bool has_displaced() const { return has_displaced_; }
  /// By how much less gaps are at once, along unit vectors from this rod to others [mm].
  template <class F>
  SHAKEN_INLINE F shift_along(const lanes::Vectors<F>& d) const {
    return shift_rounding_ + nearer(shift_, tip_shift_, d);
  }
  /// The same along any direction [mm].
  float shift_in_any_direction() const { return shift_rounding_ + size(shift_) + size(tip_shift_); }

 private:
  template <class F>
  SHAKEN_INLINE static F nearer(const float* centre, const float* tip, const lanes::Vectors<F>& d) {
    const F of_centre = centre[0] * d.x + centre[1] * d.y + centre[2] * d.z;
    const F of_tip = tip[0] * d.x + tip[1] * d.y + tip[2] * d.z;
    return of_centre + lanes::abs(of_tip);
  }
  static float size(const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

  float velocity_[3];
  float tip_[3];  ///< velocity of the rod's end relative to its centre [mm/s]
  float rounding_;
  float any_direction_;
  float curvature_;
  bool has_displaced_ = false;
  float shift_[3];  ///< the same of places, if it was displaced [mm]
  float tip_shift_[3];
  float shift_rounding_;
};

// Inlined: the vectors that go in are there already (2 % of the time).
SHAKEN_INLINE VelocityJump::VelocityJump(const Vec3& velocity, const Vec3& turning, double rate_before, double rate,
                                         double half_length)
    : curvature_(static_cast<float>(0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before))) {
  set_vector(velocity_, velocity);
  set_vector(tip_, half_length * turning);
  const float speed = size(velocity_);
  const float tip_speed = size(tip_);
  rounding_ = margins::kJumpSpeed + margins::kJump * (speed + tip_speed);
  const float faster = std::max(tip_speed, static_cast<float>(half_length * (rate - rate_before)));
  any_direction_ = rounding_ + (speed + faster) * (1.0F + margins::kJump);
}

/// How a rod flies at a tick; it is slow if it moves along x and y by less than `slow_speed` [mm/s].
FlightBound flight_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow_speed);

}  // namespace shaken
