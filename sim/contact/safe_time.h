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

/// What a bound knows of a rod at the instant from which time is counted, and how far the rod may stray from it when
/// it is hit: as long as it keeps to its limits, the bound holds. There are two sets of limits, narrow ones round the
/// motion as it is now, and wide ones round the motion as it was when they were set.
///
/// Whatever hits the rod, its velocity stays within a cylinder (Allowance) round a centre, and its director obeys
/// n(t) = n + integral of w + R with w within a cylinder round another and |R| <= half_rate2 t^2: a hit at time t_k
/// changes w by (change of precession) x n(t_k), and the rest is the curvature of the precession.
struct Outlook {
  float director[3];
  float velocity[3];       ///< of the centre; centre of its narrow limits [mm/s]
  float turning[3];        ///< d director / dt; the same [1/s]
  float half_rate2;        ///< half of the director's largest second derivative within the narrow limits [1/s^2]
  float wide_velocity[3];  ///< centre of the wide limits [mm/s]
  float wide_turning[3];   ///< [1/s]
  float wide_half_rate2;   ///< [1/s^2]
};

/// Radii and half-heights of the cylinders that a rod keeps to. Plates hit a rod along z and thousands of times per
/// second, neighbours mostly lie beside it: wide limits along z and narrow ones across cost little and last long.
struct Allowance {
  float velocity_xy;  ///< [mm/s]
  float velocity_z;   ///< [mm/s]
  float turning_xy;   ///< [1/s]
  float turning_z;    ///< [1/s]
};
struct Allowances {
  Allowance narrow;
  Allowance wide;
};

/// Two bounds on the same pair [s]: as long as both rods keep to their narrow limits, or to their wide ones.
struct SafeTime {
  float narrow;
  float wide;
};

inline void set_vector(float* to, const Vec3& from) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(from[c]);
}

inline void add_vector(float* to, const Vec3& more) {
  for (int c = 0; c < 3; ++c) to[c] += static_cast<float>(more[c]);
}

}  // namespace shaken
