// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/scene.h"

namespace shaken {

/// One kind of rod, ready for use: beads, the convex hull they lie in, and what quadrature gives of their union.
struct Species {
  std::vector<double> bead_offset;  ///< (n_beads) of the bead centres along the rod, ascending, symmetric about 0 [mm]
  std::vector<double> bead_radius;  ///< (n_beads) [mm]
  double half_length = 0;           ///< h, distance of the end-bead centres from the rod's centre [mm]
  double mid_radius = 0;            ///< of the centre bead [mm]
  double end_radius = 0;            ///< of the end beads [mm]
  double max_radius = 0;            ///< the larger of the two [mm]
  double area = 0;                  ///< of the union of the beads' discs, axis in the plane [mm^2]
  double mass = 0;                  ///< [mg]
  double inertia_perp = 0;          ///< about an axis through the centre, across the rod [mg mm^2]
  double inertia_par = 0;           ///< about the rod's axis [mg mm^2]

  int n_beads() const { return static_cast<int>(bead_offset.size()); }
  /// Loss of radius per length along the axis, (mid_radius - end_radius) / half_length; 0 for a sphere.
  double taper() const { return half_length > 0 ? (mid_radius - end_radius) / half_length : 0.0; }
};

/// Model: uniform solid of revolution of the union of the beads; profile R(x) = max over beads of
/// sqrt(r_b^2 - (x - s_b)^2), integrated piece by piece between the circles' crossings, so exact to rounding.
Species make_species(const RodShape& shape);

/// The fewest beads, an odd number, whose distance does not exceed `pitch` [mm].
int beads_for_pitch(double length, double end_diameter, double pitch);

}  // namespace shaken
