#pragma once

#include <algorithm>
#include <cmath>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/bounds/margins.h"
#include "sim/lanes/lanes.h"

/// Rigorous lower bounds on the time until two flying rods can touch (bounds/hull_safe_time.h, bead_safe_time.h). The
/// scheduled stepper does not look at a pair before that time; a bound that is too long by one tick would be a missed
/// collision, so every estimate errs on the early side and says why.
///
/// Bounds are made in floats, many at a time: they decide when to look, never what is found, so no rounding of theirs
/// reaches a trajectory. Margins cover it.
namespace shaken {

using lanes::kLanes;

/// What a bound knows of a rod in free flight, at the instant from which time is counted: its director obeys n(t) = n +
/// turning t + R with |R| <= half_rate2 t^2.
struct FlightBound {
  float director[3];
  float velocity[3];  ///< of the centre [mm/s]
  /// What `velocity` is rounded by, at most: it grows with the rod's own speed, however slowly two rods move relative
  /// to each other [mm/s].
  float velocity_rounding = 0;
  float turning[3];   ///< d director / dt [1/s]
  float half_rate2;   ///< |precession|^2 / 2, half of the director's largest second derivative [1/s^2]
  bool slow = false;  ///< along x and y, so that only the nearest image can be met (image_safe_time)
};

/// A lower bound on the gap of a pair, a straight line in time: at the bound's end the gap is at least `residual`, and
/// before that larger by `rate` for each second that is still to come. Where a hit makes the gap close faster, the time
/// that remains follows from it (schedule/gap_budgets.h).
struct GapBound {
  float rate = 0;          ///< at which the gap closes [mm/s]
  float residual = -1;     ///< [mm]; < 0: not known, so that the bound does not survive a hit
  bool isotropic = false;  ///< the gap is along no single direction

  /// A bound of a gap that is `now` wide, at least `at_end` after `time`, and concave in between [mm, s]; for a bound
  /// that ends after `end`, which is no later than `time`.
  static GapBound between(float now, float at_end, float time, float end, bool isotropic) {
    const float rate = (now - at_end) / (time + 1e-20F);
    return {rate, std::max(0.0F, now - rate * end - margins::rounding_of_gap(now)), isotropic};
  }
};

inline void set_vector(float* to, const Vec3& from) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(from[c]);
}

/// Half a unit of the last of a float's 24 bits, of every component.
inline void set_velocity(FlightBound& bound, const Vec3& velocity) {
  set_vector(bound.velocity, velocity);
  const float* v = bound.velocity;
  bound.velocity_rounding = margins::kVelocity * (std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]));
}

/// Time for which no image of rod j can touch rod i but the one that is nearest now, at most `horizon` [s]. The other
/// bounds on a pair are of that image alone, and hold for the pair no longer than this.
/// Model:  every other image is a box further along x or y, so its centre is at least L - |D_x| away along x, or
///         L - |D_y| along y; it comes nearer no faster than the centres move along that axis; and where rods touch,
///         their centres are no further apart than `reach` along any axis. In a box that is wide enough
///         (least_box_side) the time is never 0.
/// Arguments: D from centre i to the nearest centre j [mm], `reach` the sum of both rods' (Species::reach()) [mm].
inline float image_safe_time(const Vec3& D, const FlightBound& i, const FlightBound& j, const Box& box, double reach,
                             float horizon) {
  float safe = horizon;
  for (int c = 0; c < 2; ++c) {
    const auto room =
        static_cast<float>((box[c] - std::abs(D[c]) - reach) - margins::kImageRoom * box[c]);  // less the rounding
    const float speed = std::abs(j.velocity[c] - i.velocity[c]) + (i.velocity_rounding + j.velocity_rounding);
    const float open = std::max(room, 0.0F) * (1.0F - margins::kTime);
    if (speed * safe > open) safe = open / speed;
  }
  return safe;
}

/// Whether no other image of rod j can come to touch rod i within `horizon` [s] if neither moves faster than `speed`
/// along x or y [mm/s].
inline bool images_stay_away(const Vec3& D, const Box& box, double reach, double speed, double horizon) {
  const Vec2 open = box.sides() * (1 - margins::kImageRoom) - D.head<2>().cwiseAbs();
  const double room = open.minCoeff() - reach;
  return room > 2 * speed * horizon;
}

}  // namespace shaken
