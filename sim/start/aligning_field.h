#pragma once

#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/start/director_patterns.h"

namespace shaken {

/// A field that turns rods towards a director pattern: the pattern's order tensor, smoothed, on a grid over a periodic
/// box. It is weak at defects and at seams of domains, where rods find their own directions: held there, they would
/// leave a void.
class AligningField {
 public:
  /// Smoothed by diffusion to a Gaussian of standard deviation `smoothing` [mm]; meshes are a quarter of it at most.
  AligningField(const Box& box, const DirectorAt& directors, double smoothing);

  /// sin 2 delta times the strength of the field, in [0, 1], for a rod along the unit vector `along` at `place` [mm],
  /// anywhere; delta is the angle to the field's director, positive if the rod has to turn counterclockwise.
  double torque(const Vec2& place, const Vec2& along) const;

 private:
  const Vec2& at(int i, int j) const { return q_[static_cast<std::size_t>(j) * columns_ + i]; }
  void diffuse();

  Box box_;
  int columns_, rows_;
  std::vector<Vec2> q_;  ///< (rows_ * columns_), i fastest: (cos, sin) of twice the angle, and shorter by the smoothing
};

}  // namespace shaken
