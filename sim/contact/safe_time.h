// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "sim/core/lanes.h"
#include "sim/core/types.h"

/// Rigorous lower bounds on the time until two flying rods can touch (contact/hull_safe_time.h, bead_safe_time.h). The
/// scheduled stepper does not look at a pair before that time; a bound that is too long by one tick would be a missed
/// collision, so every estimate errs on the early side and says why.
///
/// Bounds are made in floats, many at a time: they decide when to look, never what is found, so no rounding of theirs
/// reaches a trajectory. Margins cover it.
namespace shaken {

using lanes::kLanes;

/// What a bound knows of a rod at the instant from which time is counted: how it flies now, and within which limits
/// hits may change that before the bound must be made anew.
///
/// Whatever hits a rod within its tolerance, its velocity stays within a cylinder (MotionTolerance) round a centre, and
/// its director obeys n(t) = n + integral of w + R with w within a cylinder round another and |R| <= limit_half_rate2
/// t^2: a hit at time t_k changes w by (change of precession) x n(t_k), and the rest is the curvature of the
/// precession.
struct MotionBound {
  float director[3];
  float velocity[3];         ///< of the centre [mm/s]
  float turning[3];          ///< d director / dt [1/s]
  float half_rate2;          ///< |precession|^2 / 2, half of the director's largest second derivative [1/s^2]
  float velocity_centre[3];  ///< of the cylinder that the velocity drifts in [mm/s]
  float turning_centre[3];   ///< the same for d director / dt [1/s]
  float limit_half_rate2;    ///< what half_rate2 may grow to [1/s^2]
};

/// Radii and half-heights of the cylinders. Plates hit a rod along z and thousands of times per second, neighbours
/// mostly lie beside it: wide limits along z and narrow ones across cost little and last long.
struct MotionTolerance {
  float velocity_xy;  ///< [mm/s]
  float velocity_z;   ///< [mm/s]
  float turning_xy;   ///< [1/s]
  float turning_z;    ///< [1/s]
};

/// Two bounds on the same pair [s].
struct SafeTime {
  float unperturbed;  ///< as long as neither rod is hit
  float perturbed;    ///< whatever hits them, as long as both keep within their tolerance
};

inline void set_vector(float* to, const Vec3& from) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(from[c]);
}

inline void add_vector(float* to, const Vec3& more) {
  for (int c = 0; c < 3; ++c) to[c] += static_cast<float>(more[c]);
}

}  // namespace shaken
