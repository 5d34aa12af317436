// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

#include "sim/core/types.h"
#include "sim/rod/species.h"

/// Rigorous lower bounds on the time until two flying rods can touch. The scheduled stepper does not look at a pair
/// before that time; a bound that is too long by one tick would be a missed collision, so every estimate below errs
/// on the early side and says why.
namespace shaken {

inline constexpr double kForever = std::numeric_limits<double>::infinity();
/// Kept back from every gap [mm] and from every rate of separation [mm/s]: far above rounding, far below what matters.
inline constexpr double kGapMargin = 1e-9;
inline constexpr double kRateMargin = 1e-6;

/// How far a rod's velocity may stray from what a bound was made with before the bound must be renewed. Small changes
/// (a rod that chatters on a plate) then cost nothing; in exchange every gap is taken to shrink that much faster.
struct Allowance {
  double velocity;  ///< of the centre [mm/s]
  double
      precession;  ///< [rad/s]; a director that precesses differently by this much strays by at most this, times time
};

/// Motion of one rod as a bound sees it, at the instant from which time is counted.
struct FlightState {
  Vec3 director;
  Vec3 velocity;  ///< of the centre [mm/s]
  Vec3 turning;   ///< d director / dt [1/s]
  double rate2;   ///< |precession|^2: bounds the second derivative of the director [1/s^2]
};

/// Cosine between a rod and a fixed direction as it was known at some earlier instant; for all later times
/// |n . d| <= |c + rate s| + half_rate2 s^2 + (allowance) s, with s the time since then.
struct AxisCosine {
  double c;           ///< n . d
  double rate;        ///< [1/s]
  double half_rate2;  ///< |precession|^2 / 2 [1/s^2]
  double age;         ///< s at the instant from which the bound counts time [s]
};

/// Hull of a rod: convex, radius mid_radius - taper |s| along the axis; half its width in a direction at cosine c to
/// the axis is mid_radius + half_length max(0, |c| - taper).
struct Hull {
  explicit Hull(const Species& species)
      : half_length(species.half_length), mid_radius(species.mid_radius), taper(species.taper()) {}
  double half_length;
  double mid_radius;
  double taper;
};

/// Unit vector from hull i towards hull j along which they are (nearly) furthest apart; any direction gives a valid
/// bound, a good one gives a long one. D: from centre i to centre j.
Vec3 separating_direction(const Hull& i, const Vec3& n_i, const Hull& j, const Vec3& n_j, const Vec3& D);

/// Gap of the hulls along a direction [mm]: `separation` is D . d, the cosines are n . d. Negative: they overlap there.
double hull_gap(const Hull& i, double c_i, const Hull& j, double c_j, double separation);

/// Time for which the hulls stay apart along the fixed direction d, at most `horizon`.
/// Model:  gap(t) >= separation + (rate - 2 allowance) t - width_i(t) - width_j(t); the centres' difference is linear
/// in
///         time because gravity acts on both alike, and the widths grow at most as AxisCosine says. The right side is
///         concave in t, so a chord from a time at which it is positive to one at which it is not meets zero before it
///         does.
double hull_safe_time(const Hull& i, const AxisCosine& axis_i, const Hull& j, const AxisCosine& axis_j,
                      double separation, double rate, const Allowance& allowance, double horizon);

/// A species' beads as floats in whole vectors, for bead_safe_time.
struct BeadLanes {
  static constexpr int kLanes = 16;
  explicit BeadLanes(const Species& species);
  std::vector<float> offset;  ///< (n_beads rounded up to a multiple of kLanes) [mm]
  std::vector<float> radius;  ///< the same; lanes past the last bead hold a bead that is never near [mm]
  float half_length, mid_radius, max_radius, taper;
  float last;   ///< index of the last bead
  float pitch;  ///< distance of neighbouring beads [mm]
  int reach;    ///< beads to each side of a foot that can be near: those beyond are further than any contact
};

/// Time for which no bead of i and bead of j begins to touch or, if they overlap, begins to approach; at most
/// `horizon`. For rods whose hulls overlap while the beads interlock without touching. Model:  along the line of
/// centres e of two beads, e . r(t) >= r + r' t - (|s_a| W_i^2 + |s_b| W_j^2) t^2 / 2, and the
///         distance is at least that. Each bead of i is tried against the beads of j next to its foot on j's axis;
///         those beyond are covered by their distance and the fastest approach.
/// Numerics: floats, 16 beads at a time; margins cover the rounding.
double bead_safe_time(const BeadLanes& i, const FlightState& state_i, const BeadLanes& j, const FlightState& state_j,
                      const Vec3& D, const Allowance& allowance, double horizon);

}  // namespace shaken
