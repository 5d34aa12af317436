#pragma once

#include "render/canvas.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// Where things stand: the box as large as it can be, and everything written beside it (wide pictures) or below it
/// (square and tall ones), never on the rods. A rectangle without width is not drawn.
struct Layout {
  double unit = 1;  ///< the size of everything that is not to scale: 1 in a picture 720 pixels high
  int box_x = 0, box_y = 0, box_side = 0;  ///< the square of the rods [pixels]
  int stage_width = 0,
      stage_height = 0;  ///< of a view in perspective, from the upper left corner; there is then no box
  Rect label, numbers, history, legend, species, key, ground, scale_bar;
  bool is_bar_on_rods = false;  ///< the scale bar
  Rect inset;                   ///< in the column beside the rods; on the rods, in their upper right corner, where
                                ///< there is none; without width also where there is no room for it
  bool is_inset_on_rods = true;
};

/// What there is to be shown, besides what the style asks for.
struct Contents {
  bool history = false;  ///< S(t)
  bool label = false;
  int species = 0;    ///< how many are to be told apart: none if there is one
  bool scale = true;  ///< a colour scale: colours that are names have none
};
Layout layout_of(const PictureStyle& style, const Contents& contents);

/// Gives the inset its place on the box, or on the stage, if the style asks for one that has none yet.
void place_inset(Layout& layout, const PictureStyle& style);

/// The layout of a view in perspective: the stage over the whole width, and a strip below it with all that is written.
Layout stage_layout_of(const PictureStyle& style, const Contents& contents);

}  // namespace shaken::render
