#pragma once

#include "sim/bounds/safe_time.h"
#include "sim/rod/species.h"

namespace shaken {

/// Hull of a rod: convex, radius mid_radius - taper |s| along the axis; half its width in a direction at cosine c to
/// the axis is mid_radius + half_length max(0, |c| - taper).
struct Hull {
  explicit Hull(const Species& species)
      : half_length(static_cast<float>(species.half_length)),
        mid_radius(static_cast<float>(species.mid_radius)),
        taper(static_cast<float>(species.taper())) {}
  float half_length;
  float mid_radius;
  float taper;
};

/// Gap of the hulls along a unit vector d [mm]: the cosines are |n . d|, `separation` is D . d. Negative: they overlap
/// there.
inline double hull_gap(const Hull& i, double c_i, const Hull& j, double c_j, double separation) {
  const auto half_width = [](const Hull& hull, double c) {
    const double lean = c - static_cast<double>(hull.taper);
    return static_cast<double>(hull.mid_radius) + static_cast<double>(hull.half_length) * (lean > 0 ? lean : 0.0);
  };
  return separation - half_width(i, c_i) - half_width(j, c_j);
}

/// kLanes pairs (i, j), component by component.
struct PairLanes {
  alignas(64) float D[3][kLanes];  ///< from centre i to centre j [mm]
  alignas(64) float director_i[3][kLanes];
  alignas(64) float director_j[3][kLanes];
  alignas(64) float turning_i[3][kLanes];
  alignas(64) float turning_j[3][kLanes];
  alignas(64) float velocity[3][kLanes];  ///< of j relative to i
  alignas(64) float velocity_rounding[kLanes];
  alignas(64) float half_rate2_i[kLanes];
  alignas(64) float half_rate2_j[kLanes];

  void set(int lane, const Vec3& D_ij, const FlightBound& i, const FlightBound& j);
};

/// Bounds for kLanes pairs, and the directions that they were taken along.
struct HullSafeTimes {
  alignas(64) float direction[3][kLanes];  ///< unit vectors from hull i towards hull j
  alignas(64) float time[kLanes];          ///< [s]
  alignas(64) float gap[kLanes];           ///< along that direction, now [mm]
  alignas(64) float gap_at_end[kLanes];    ///< the same when the time is over, at least [mm]
};

/// Times for which the hulls of the first `n` pairs stay apart, at most `horizon` [s]; 0 if they overlap.
///
/// Model:    along a fixed direction d,
///               gap(t) >= (D + v t) . d - w_i(t) - w_j(t)
///               w(t)    = r + h max(0, |n . d + (n' . d) t| + q t^2 - taper)
///           The right side is concave in t, so a chord from a time at which it is positive to one at which it is not
///           meets zero before it does. Any d gives a valid bound; this one is near the direction of the largest gap:
///           closest points of the axes, moved twice towards the thick middles.
/// Symbols:  D      from centre i to centre j [mm]
///           v      velocity of j relative to i, constant because gravity acts on both alike [mm/s]
///           r, h   mid_radius and half_length of a hull [mm]
///           n, n'  its director, and that director's rate of change [1/s]
///           q      half_rate2: bounds what else the director does [1/s^2]
void hull_safe_times(const Hull& i, const Hull& j, const PairLanes& pairs, int n, float horizon, HullSafeTimes& safe);

}  // namespace shaken
