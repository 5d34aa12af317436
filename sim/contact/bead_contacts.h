#pragma once

#include <algorithm>
#include <vector>

#include "base/core/types.h"
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
[[gnu::always_inline]] inline double segment_distance_squared(const Vec3& D, const Vec3& n_i, double h_i,
                                                              const Vec3& n_j, double h_j) {
  // minimise |D + t n_j - s n_i|^2 over |s| <= h_i, |t| <= h_j
  const double c = n_i.dot(n_j);
  const double d_i = D.dot(n_i);
  const double d_j = D.dot(n_j);
  const double det = 1.0 - c * c;
  double s = det > 1e-12 ? std::clamp((d_i - c * d_j) / det, -h_i, h_i) : std::clamp(d_i, -h_i, h_i);
  const double t = std::clamp(c * s - d_j, -h_j, h_j);
  s = std::clamp(d_i + c * t, -h_i, h_i);
  return (D + t * n_j - s * n_i).squaredNorm();
}

/// Some beads of a rod, one after the other.
struct BeadRange {
  int from = 0;
  int to = 0;  ///< one past the last
  bool empty() const { return from >= to; }
};

/// Appends every pair of overlapping beads of rods i and j, ordered by (bead_i, bead_j), with bead_i among `beads`.
/// D is the vector from the centre of rod i to that of rod j (nearest periodic image) [mm].
/// Whether a pair is found depends on nothing else: all steppers call this one function.
void find_bead_contacts(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j, const Vec3& D,
                        BeadRange beads, std::vector<BeadContact>& contacts);

/// The same for all beads of i, after a look at the rods' axes: most neighbours are apart.
void find_bead_contacts(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j, const Vec3& D,
                        std::vector<BeadContact>& contacts);

}  // namespace shaken
