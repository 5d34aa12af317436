// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/core/types.h"
#include "sim/rod/species.h"

namespace shaken {

/// Two beads of two rods that overlap.
struct BeadContact {
  int bead_i;
  int bead_j;
  double overlap;  ///< radius_i + radius_j - distance of the centres, > 0 [mm]
  Vec3 normal;     ///< unit vector from bead_i's centre to bead_j's; vertical if they coincide
};

/// Squared distance of two segments: centres 0 and D, unit directions, half-lengths [mm^2].
/// Source: closest points by clamped minimisation (Ericson 2005, section 5.1.9); parallel segments included.
double segment_distance_squared(const Vec3& D, const Vec3& n_i, double h_i, const Vec3& n_j, double h_j);

/// Appends every pair of overlapping beads of rods i and j, ordered by (bead_i, bead_j).
/// D is the vector from the centre of rod i to that of rod j (nearest periodic image) [mm].
/// Which pairs are found depends on nothing but the arguments: both steppers call this one function.
void find_bead_contacts(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j, const Vec3& D,
                        std::vector<BeadContact>& contacts);

}  // namespace shaken
