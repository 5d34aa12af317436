// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "sim/contact/safe_time.h"
#include "sim/motion/flight.h"

namespace shaken {

/// In which direction the hulls of two rods were apart; 0: not known.
using Direction = std::array<float, 3>;

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

  /// Speed along a unit vector from this rod to the other, or from the other to it [mm/s].
  float along(const Direction& d, bool from_this) const {
    const float v = velocity_[0] * d[0] + velocity_[1] * d[1] + velocity_[2] * d[2];
    const float tip = tip_[0] * d[0] + tip_[1] * d[1] + tip_[2] * d[2];
    return rounding_ + (from_this ? v : -v) + std::abs(tip);
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

/// How a rod flies at a tick; it is `slow` if it moves along x and y by less than that [mm/s].
MotionBound motion_bound(const Flight& flight, const Vec3& velocity, const Vec3& director, float slow);

}  // namespace shaken
