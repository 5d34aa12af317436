#pragma once

#include <vector>

#include "base/core/types.h"

namespace shaken::analysis {

/// n x n places `spacing` apart along x and y, in a box of side n * spacing.
inline std::vector<Vec3> square_lattice(int n, double spacing) {
  std::vector<Vec3> places;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) places.emplace_back(spacing * i, spacing * k, 0.5);
  }
  return places;
}

/// Rows along y of `columns` places in a box of side `box`, `rows` of them (even), every other row shifted by half a
/// place: hexagonal where box / rows = sqrt(3) / 2 * box / columns, otherwise stretched along x.
inline std::vector<Vec3> hexagonal_lattice(int columns, int rows, double box) {
  std::vector<Vec3> places;
  for (int row = 0; row < rows; ++row) {
    for (int k = 0; k < columns; ++k) {
      places.emplace_back(box / rows * row, box / columns * (k + (row % 2 == 0 ? 0.0 : 0.5)), 0.5);
    }
  }
  return places;
}

}  // namespace shaken::analysis
