#pragma once

#include <vector>

#include "analysis/errors/saved.h"
#include "analysis/geometry/director_field.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// A topological defect of the director field.
struct Defect {
  Vec2 position = Vec2::Zero();  ///< in the box [mm]
  double charge = 0;             ///< +1/2 or -1/2; a tie of exactly perpendicular neighbours can give +-1
  /// Angle of the ray from the core along which the director is radial [rad]: one ray for +1/2, in [-pi, pi); one of
  /// three for -1/2, in [-pi/3, pi/3). 0 for charge +-1.
  double direction = 0;
  static auto fields(auto& self) { return listed(self.position, self.charge, self.direction); }
};

/// All defects of the field: every plaquette of the grid round whose four edges the director turns by +-pi, each step
/// taken the shorter way, and is defined at all four corners (DirectorField::is_defined): there are none in the void
/// and none beyond walls. Position: zero of the bilinear Q in the plaquette. Direction: Vromans & Giomi, Soft Matter
/// 12, 6490 (2016), eq. 5, averaged over a ring round the core whose radius is the smoothing length, or half the
/// distance to the next defect if that is less. The charges of a periodic box add up to exactly zero where the director
/// is defined everywhere, whatever it is. Nothing is merged: where the order is low, noise makes +- pairs a mesh apart,
/// and they are reported.
std::vector<Defect> find_defects(const DirectorField& field);

}  // namespace shaken::analysis
