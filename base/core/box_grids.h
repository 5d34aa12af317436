#pragma once

#include <algorithm>
#include <cmath>

#include "base/core/box.h"

namespace shaken {

// How many waves and nodes there are over a box, whole numbers along x and y: what divides it must neither lose a wave
// nor gain a node by rounding.

/// The largest wave numbers where there are `waves` along the longer side.
inline Vec2 most_waves(const Box& box, double waves) {
  return (waves / box.longer() * box.sides() * (1 + 1e-12)).array().floor();
}
/// Nodes that are no farther from each other than `mesh` [mm], at least four each way.
inline Vec2 grid_nodes(const Box& box, double mesh) {
  return (box.sides() / mesh).array().unaryExpr([](double nodes) { return std::max(4.0, std::ceil(nodes - 1e-9)); });
}

}  // namespace shaken
