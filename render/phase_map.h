// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// The rods of a sweep over one or two parameters: a small picture for each of its points.
struct PhaseMap {
  struct Axis {
    std::string title;                ///< with its unit; empty if nothing is swept along it
    std::vector<std::string> values;  ///< from left to right, or from the bottom to the top; one at least
  };
  struct Cell {
    std::size_t column = 0, row = 0;    ///< of the axes' values
    std::optional<RodPicture> picture;  ///< none if its run has no frame yet
  };
  Axis x, y;
  std::vector<Cell> cells;
};

/// Where its parts stand.
struct MapLayout {
  double unit = 1;  ///< as in Layout
  int side = 0;     ///< of a cell [pixels]
  Rect cells;       ///< all of them
  Rect legend;      ///< the colours, above; without width if the style has no legend
  int step = 0;     ///< from one cell to the next [pixels]
  /// The upper left corner of a cell.
  Vec2 corner(const PhaseMap::Cell& cell) const {
    return {cells.x + static_cast<double>(cell.column) * step,
            cells.bottom() - static_cast<double>(cell.row) * step - side};
  }
};
MapLayout map_layout(const PhaseMap& map, const PictureStyle& style);

/// The axes with their values, the colours, a frame round each cell, and "no frame yet" in cells without a picture.
void draw_map_words(const Canvas& canvas, const MapLayout& layout, const PhaseMap& map, const PictureStyle& style);

}  // namespace shaken::render
