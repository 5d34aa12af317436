#pragma once

#include <span>
#include <vector>

#include "sim/rod/bead_row.h"
#include "sim/system.h"

namespace shaken {

/// No rod has more beads: a scene that asks for more is refused.
inline constexpr int kMostBeads = 101;

/// One end of a rod's hull.
struct HullEnd {
  double length = 0;  ///< from the rod's centre to the end-bead's [mm]
  double radius = 0;  ///< of the hull there [mm]
};

/// One kind of rod, ready for use: beads, the hull they lie in, and what quadrature gives of their union. The centre of
/// a rod is its centre of mass; for rods that are the same fore and aft that is the middle.
///
/// The hull's radius is mid_radius at the centre and changes linearly to both ends; every bead lies in it.
struct Species {
  std::vector<double> bead_offset;  ///< (n_beads) of the bead centres along the rod, ascending, equally spaced [mm]
  std::vector<double> bead_radius;  ///< (n_beads) [mm]
  std::vector<int> outer_beads;     ///< those that can be the lowest, highest or outermost of the rod, ascending
  double half_length = 0;           ///< h, distance of the farther end-bead's centre from the rod's centre [mm]
  double mid_radius = 0;            ///< of the hull at the centre [mm]
  double end_radius = 0;            ///< mid_radius - taper() half_length [mm]
  double max_radius = 0;            ///< the largest of the hull [mm]
  HullEnd tail, head;               ///< at the first and at the last bead
  double area = 0;                  ///< of the union of the beads' discs, axis in the plane [mm^2]
  double mass = 0;                  ///< [mg]
  double inertia_perp = 0;          ///< about an axis through the centre, across the rod [mg mm^2]
  double inertia_par = 0;           ///< about the rod's axis [mg mm^2]
  double inertia_ratio = 0;         ///< I_par / I_perp

  int n_beads() const { return static_cast<int>(bead_offset.size()); }
  /// Distance of neighbouring beads [mm]; 1 for a sphere.
  double pitch() const { return n_beads() > 1 ? (bead_offset.back() - bead_offset.front()) / (n_beads() - 1) : 1.0; }
  BeadRow beads() const { return {bead_offset, bead_radius}; }
  /// The farthest that any bead reaches from the centre [mm].
  double reach() const { return beads().reach(); }
  /// Loss of the hull's radius per length towards an end; 0 for a sphere.
  double taper(const HullEnd& end) const { return end.length > 0 ? (mid_radius - end.radius) / end.length : 0.0; }
  /// That towards the end where it is less.
  double taper() const { return half_length > 0 ? (mid_radius - end_radius) / half_length : 0.0; }
};

/// Model: uniform solid of revolution of the union of the beads; profile R(x) = max over beads of
/// sqrt(r_b^2 - (x - s_b)^2), integrated piece by piece between the circles' crossings, so exact to rounding. With
/// Inertia::kBeads the centre of mass and the moments of inertia are those of the beads added up, of the same mass.
Species make_species(const RodShape& shape);

/// The narrowest periodic box for rods of these kinds [mm]. Two rods whose centres are half a box apart must not touch,
/// so that only the nearest image of a rod can: four times the farthest reach, and a tenth of that for good measure.
double least_box_side(std::span<const Species> species);

/// The fewest beads, an odd number, whose distance does not exceed `pitch` [mm].
int beads_for_pitch(double length, double end_diameter, double pitch);

}  // namespace shaken
