// SPDX-License-Identifier: MIT
#pragma once

#include "sim/contact/safe_time.h"
#include "sim/motion/flight.h"

namespace shaken {

/// How far a rod may drift before the bounds of its pairs are renewed: from one hit by a neighbour to the next, mostly.
inline constexpr MotionTolerance kMotionTolerance{1.0F, 25.0F, 1.0F, 12.0F};

/// What hits have changed of a rod's motion since the bounds of its pairs were last renewed. Plates hit a rod thousands
/// of times per second; as long as the sum of it stays within kMotionTolerance, those bounds hold
/// (contact/safe_time.h).
class MotionDrift {
 public:
  /// From now on, as the rod flies now.
  void restart(const Flight& flight);

  /// A hit changed the velocity [mm/s] and the director's rate of change [1/s] by so much.
  void add(const Vec3& velocity, const Vec3& turning) {
    add_vector(velocity_, velocity);
    add_vector(turning_, turning);
  }
  /// The precession changed by `change` [rad/s] a little before the tick's end, where the director was not quite what
  /// it is at the end.
  void add_earlier(double change, double dt) {
    turning_error_ += static_cast<float>(change * static_cast<double>(rate_limit_) * dt);
  }

  bool is_tolerated(const Flight& flight) const;

  /// For bounds that are made now; `velocity` and `director` as they are now.
  MotionBound bound(const Flight& flight, const Vec3& velocity, const Vec3& director) const;

 private:
  float velocity_[3] = {0, 0, 0};  ///< [mm/s]
  float turning_[3] = {0, 0, 0};   ///< [1/s]
  float turning_error_ = 0;        ///< what turning_ may be wrong by [1/s]
  float rate_limit_ = 0;           ///< of the precession [rad/s]
};

}  // namespace shaken
