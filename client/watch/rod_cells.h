#pragma once

#include <vector>

#include "client/live/rod_frame.h"
#include "client/watch/cells.h"
#include "client/watch/rod_samples.h"

namespace shaken::client {

/// What a cell is filled with.
enum class Grain {
  kAuto,     ///< half blocks where the terminal has colours, dots where it has none
  kBlocks,   ///< two coloured halves, each mixed from 2 x 2 samples
  kBraille,  ///< 2 x 4 dots of one colour: finer
};

/// How rods are drawn. `colouring` and `grain` are not kAuto here.
struct RodStyle {
  Colouring colouring = Colouring::kLayers;
  Grain grain = Grain::kBlocks;
  bool in_colour = true;  ///< otherwise dots in the terminal's own colour
  bool mixes = true;      ///< the terminal has enough colours for half-covered blocks
  bool shows_defects = true;
};

/// Draws `frame` into `area` of `grid` from 2 x 4 samples in each cell, as RodSamples says.
void draw_rods(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
               const RodStyle& style, const Area& area, CellGrid& grid);

/// Marks defects, those that lie in the box, over what is drawn of `samples`.
void mark_defects(const RodSamples& samples, const std::vector<DefectMark>& defects, const RodStyle& style,
                  const Area& area, CellGrid& grid);

}  // namespace shaken::client
