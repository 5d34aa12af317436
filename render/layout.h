// SPDX-License-Identifier: MIT
#pragma once

#include "render/canvas.h"
#include "render/picture.h"

namespace shaken::render {

/// Where things stand: the box as large as it can be, and everything written beside it (wide pictures) or below it
/// (square and tall ones), never on the rods. A rectangle without width is not drawn.
struct Layout {
  double unit = 1;  ///< the size of everything that is not to scale: 1 in a picture 720 pixels high
  int box_x = 0, box_y = 0, box_side = 0;  ///< the square of the rods [pixels]
  Rect label, numbers, history, legend, species, key, scale_bar;
};

/// `with_species`: whether there are several species to be told apart.
Layout layout_of(const PictureStyle& style, bool with_history, bool with_label, bool with_species = false);

}  // namespace shaken::render
