#pragma once

#include <cmath>

/// Every margin by which a bound errs on the early side, in one place, but for those of side walls and posts, which
/// contacts with them share (motion/side_walls.cpp, post_contacts.cpp). Bounds are computed in single precision (a
/// float carries 6e-8 of its value), so each sum and product may be wrong by that, and each margin says how many such
/// errors it covers. A margin that is too small is a contact that is found late: the trajectory would differ from the
/// reference stepper's. One that is too large only brings rods and pairs up sooner. docs/stepper.md says what they are
/// for; tests/regression/margins.py says which tests fail without one.
namespace shaken::margins {

// ---- velocities of rods (bounds/safe_time.h)

/// Half a unit of the last of a float's 24 bits: what rounding a velocity to floats does, for each component.
inline constexpr float kVelocity = 6.1e-8F;

// ---- hulls of two rods (bounds/hull_safe_time.cpp)

/// The gap, of the lengths that it is the difference of: a dozen roundings.
inline constexpr float kHullLength = 1.5e-6F;
/// And for radii, at any distance [mm].
inline constexpr float kHullRadius = 1e-6F;
/// The rate at which the gap changes, of the speeds that it is made of: a dozen roundings.
inline constexpr float kHullRate = 3e-6F;
/// And at any speed [mm/s].
inline constexpr float kHullSpeed = 1e-4F;

// ---- beads of two rods (bounds/bead_safe_time.cpp)

/// Radii and places of beads, of 1 mm and of the size of the pair.
inline constexpr float kBeadGap = 1e-6F;
/// Places of beads relative to each other, of the size of the pair: half a dozen roundings.
inline constexpr float kBeadPlace = 4e-7F;
/// The difference of two squares, of the larger one.
inline constexpr float kSquares = 1e-6F;
/// The rate of approach, of the fastest two beads: a dozen roundings.
inline constexpr float kBeadRate = 3e-6F;
/// And at any speed [mm/s].
inline constexpr float kBeadSpeed = 1e-6F;
/// The fastest approach of any two beads: of itself, and at any speed [mm/s].
inline constexpr float kFastest = 1e-5F;
inline constexpr float kFastestSpeed = 1e-3F;
/// The acceleration of beads that overlap and recede [mm/s^2].
inline constexpr float kReceding = 1e-3F;
/// A time, of itself: the divisions at its end.
inline constexpr float kTime = 1e-5F;

// ---- other images (bounds/safe_time.h)

/// The room to the next image, of the box.
inline constexpr double kImageRoom = 1e-6;

// ---- plates (bounds/plate_safe_time.cpp)

/// Heights, of the lengths that they are made of: a dozen roundings.
inline constexpr float kPlateLength = 1e-6F;
/// Velocities, of the speeds that they are made of: a dozen roundings.
inline constexpr float kPlateRate = 2e-6F;
/// And at any speed [mm/s].
inline constexpr float kPlateSpeed = 1e-4F;
/// Constants of the scene that were rounded to floats: largest accelerations, offsets of beads, speeds of rest.
inline constexpr double kPlateConstants = 1e-6;

// ---- side walls and posts (bounds/surface_safe_ticks.cpp; double precision)

inline constexpr double kWallTime = 1e-9;

// ---- hits (bounds/velocity_jump.h)

/// The speed that a hit adds to the closing of a gap, at any speed [mm/s]. It covers the rounding of the rate to which
/// it is added (half of the bound's own and all hits since), for as long as that stays below 1,700 mm/s.
inline constexpr float kJumpSpeed = 1e-4F;
/// Relative part of the same.
inline constexpr float kJump = 1e-6F;

// ---- what remains of gaps and of skins (schedule/)

/// A gap less a part of itself, of 1 mm and of the gap [mm].
inline float rounding_of_gap(float gap) { return 1e-6F * (1.0F + std::abs(gap)); }
/// A budget, each time that a hit spends some of it.
inline constexpr float kBudget = 1e-6F;
/// Two budgets and what the gap has closed, which may nearly cancel.
inline constexpr float kCancelled = 1e-6F;
/// Hulls that are further apart than this hold no overlapping beads [mm]; double precision, of a float's direction.
inline constexpr double kHullsApart = 1e-5;
/// The slack of a rod in the neighbour list, when it is measured [mm].
inline constexpr float kSkinMeasured = 1e-4F;
/// What each counting down takes of it besides: more than a float is rounded by, so that many small steps count.
inline constexpr float kSkinStep = 0x1p-22F;
/// The time until it is used up (double precision).
inline constexpr double kSkinTime = 1e-12;

}  // namespace shaken::margins
