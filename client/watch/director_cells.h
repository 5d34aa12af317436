#pragma once

#include <vector>

#include "client/live/rod_frame.h"
#include "client/watch/rod_cells.h"

namespace shaken::client {

/// Local S below which there is no director to speak of, as in automatic_colouring().
inline constexpr double kLeastLocalOrder = 0.4;

/// Whether rods are so thin that the director is drawn in their place: fewer than two samples across a rod of the first
/// species, in a picture of 2 x 4 samples in each cell of `area`. Spheres, and the colourings by tilt and species, have
/// no director to be drawn.
bool draws_director(const RodFrame& frame, const RodView& view, Colouring colouring, const Area& area);

/// Draws the smoothed director of `frame` (analysis/geometry/director_field.h) into `area` of `grid`, with the
/// smoothing that measurements of defects have if the scene says none, or half a cell if that is more. With colours,
/// half a cell has the colour of the director there, mixed with the floor by the local S; where the terminal cannot
/// mix, it has none below kLeastLocalOrder. Without colours, and as dots, a cell is a stroke along the director, or a
/// dot below that S. Defects are marked where S is above it, in the mean over a ring of two smoothing lengths round
/// them: elsewhere noise makes pairs of them.
void draw_director(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
                   const RodStyle& style, const Area& area, CellGrid& grid);

}  // namespace shaken::client
