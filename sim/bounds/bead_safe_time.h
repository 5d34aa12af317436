// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/bounds/safe_time.h"
#include "sim/contact/bead_contacts.h"
#include "sim/rod/species.h"

namespace shaken {

/// A species' beads as floats in whole vectors.
struct BeadLanes {
  explicit BeadLanes(const Species& species);
  int n_lanes() const { return static_cast<int>(offset.size()); }
  std::vector<float> offset;  ///< (n_beads rounded up to a multiple of kLanes) [mm]
  std::vector<float> radius;  ///< the same; lanes past the last bead hold a bead that is never near [mm]
  float half_length, mid_radius, max_radius;
  float taper, skew;    ///< loss of the hull's radius per length: taper + skew towards the head, taper - skew the tail
  float first;          ///< offset of the first bead, <= 0 [mm]
  float end;            ///< of the last one, >= 0 [mm]
  float last;           ///< index of the last bead
  float pitch;          ///< distance of neighbouring beads [mm]
  int reach;            ///< beads to each side of a foot that are tried one by one
  int from;             ///< the first of them, counted from the last bead before the foot
  float beyond;         ///< distance along the axis at which the others begin [mm]
  float thinning = 0;   ///< loss of radius per length that the hull is sure to have to both sides
  float cosine = 1;     ///< of the angle by which a hull with that loss narrows
  float widest = 1e6F;  ///< distance beside the axis up to which the others' gap grows along it [mm]
  float least_untried = 0;  ///< radius that the others are taken to have at least [mm]
};

/// A bound on two rods' beads.
struct BeadSafeTime {
  float time;  ///< [s]
  float gap;   ///< the least between any two beads now [mm]
};

/// Beads of i outside of which none overlaps a bead of j: a quick test before find_bead_contacts, which decides.
BeadRange beads_may_overlap(const BeadLanes& i, const Vec3& n_i, const BeadLanes& j, const Vec3& n_j, const Vec3& D);

/// Time for which no bead of i and bead of j begins to touch or, if they overlap, begins to approach; at most
/// `horizon` [s]. For rods whose hulls overlap while the beads interlock without touching.
///
/// Model:  along the line of centres e of two beads, e . r(t) >= r + r' t - (|s_a| q_i + |s_b| q_j) t^2, with q half
///         the directors' second derivative, and the distance is at least that (t^2 <= horizon t makes it linear). Each
///         bead of i is tried against the beads of j next to its foot on j's axis; those beyond are covered by their
///         distance and the fastest approach, and so are beads of i that are further from the hull of j than that.
/// Arguments: D is the vector from centre i to centre j [mm].
BeadSafeTime bead_safe_time(const BeadLanes& i, const FlightBound& bound_i, const BeadLanes& j,
                            const FlightBound& bound_j, const Vec3& D, float horizon);

}  // namespace shaken
