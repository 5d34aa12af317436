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
  float taper, skew;   ///< loss of the hull's radius per length: taper + skew towards the head, taper - skew the tail
  float first_offset;  ///< of the first bead, <= 0 [mm]
  float last_offset;   ///< of the last one, >= 0 [mm]
  float last_index;    ///< of the last bead
  float pitch;         ///< distance of neighbouring beads [mm]

  // Beads next to a foot are tried one by one: those of numbers first_tried .. last_tried, counted from the last bead
  // before the foot. The others, the untried, are covered by one bound.
  int last_tried;
  int first_tried;
  float untried_from;          ///< distance along the axis at which the untried begin [mm]
  float untried_width = 1e6F;  ///< distance beside the axis up to which their gap grows along it [mm]
  float untried_radius = 0;    ///< they are taken to have this radius at least [mm]

  float sure_taper = 0;   ///< loss of radius per length that the hull is sure to have to both sides
  float sure_cosine = 1;  ///< of the angle by which a hull with that loss narrows
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
/// Model:    along the line of centres e of two beads,
///               e . r(t) >= e . r + e . r' t - (|s_i| q_i + |s_j| q_j) t^2,
///           and their distance is at least that; t^2 <= horizon t makes it linear. Each bead of i is tried against the
///           beads of j next to its foot on j's axis. Those beyond are covered by their distance and the fastest
///           approach, and so are beads of i that are further from the hull of j than that.
/// Symbols:  D     from centre i to centre j [mm]
///           r     from a bead of i to a bead of j [mm]
///           s     offset of a bead from its rod's centre [mm]
///           q     half_rate2 of its rod: half of the bound on the director's second derivative [1/s^2]
///           foot  the point of an axis that is nearest to a bead
BeadSafeTime bead_safe_time(const BeadLanes& i, const FlightBound& bound_i, const BeadLanes& j,
                            const FlightBound& bound_j, const Vec3& D, float horizon);

}  // namespace shaken
