// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "base/core/types.h"
#include "sim/rod/species.h"

namespace shaken::bench {

/// Of two rods, the beads whose surfaces are nearest to each other.
struct NearestBeads {
  int i = 0, j = 0;
  double gap = std::numeric_limits<double>::infinity();  ///< of their surfaces; negative where they overlap [mm]
  Vec3 normal = Vec3::UnitZ();                           ///< from the centre of i's to that of j's
};

/// `D` is from the centre of the one rod to that of the other [mm].
inline NearestBeads nearest_beads(const Species& species, const Vec3& n_i, const Vec3& n_j, const Vec3& D) {
  NearestBeads nearest;
  for (int i = 0; i < species.n_beads(); ++i) {
    for (int j = 0; j < species.n_beads(); ++j) {
      const Vec3 apart = D + species.bead_offset[j] * n_j - species.bead_offset[i] * n_i;
      const double distance = apart.norm();
      const double gap = distance - species.bead_radius[i] - species.bead_radius[j];
      if (gap < nearest.gap && distance > 0) nearest = {i, j, gap, apart / distance};
    }
  }
  return nearest;
}

}  // namespace shaken::bench
