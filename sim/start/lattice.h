#pragma once

#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken {

/// A lattice that tiles the periodic box: `columns` sites to a row along x, each row shifted against the one
/// before by `turns` / `rows` of a column, so that the rows close in themselves. Each lattice of columns * rows sites
/// that the box can have is one of these, with 0 <= turns < rows (Hermite's normal form of its basis).
struct Lattice {
  int columns = 0;
  int rows = 0;
  int turns = 0;
  double clearance = 0;  ///< smallest of the gaps between rods [mm]
  int sites() const { return columns * rows; }

  /// Place of a site, 0 <= site < sites(), row by row [mm]; x may be beyond the box by less than its side.
  Vec3 position(int site, const Box& box) const {
    const int row = site / columns;
    const int column = site % columns;
    const auto shift = static_cast<double>(static_cast<long>(row) * turns % rows) / rows;
    return {(column + 0.25 + shift) * (box.x() / columns), (row + 0.5) * (box.y() / rows), 0};
  }
};

}  // namespace shaken
