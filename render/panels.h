#pragma once

#include <cstddef>
#include <vector>

#include "render/canvas.h"
#include "render/picture.h"
#include "render/picture_layout.h"
#include "render/style.h"

namespace shaken::render {

/// Several runs side by side with one clock: where each stands, and the strip below that they have in common. A panel's
/// box is as large as it can be with its headline above and its scale bar below.
struct PanelGrid {
  std::vector<Layout> panels;  ///< in the order of reading
  Rect footer;                 ///< clock, colours, speed of playing; without width if nothing is to be written
  double unit = 1;             ///< as in Layout
};
PanelGrid panel_grid(const PictureStyle& style, std::size_t n_panels);

/// Whether a picture and those beside it are of one time, which the footer then says.
bool have_one_time(const RodPicture& picture);

/// What a panel's picture has beside its rods: headline, S, scale bar, frame, defects, lines, and its time where others
/// have another one. The clock and the speed of playing are the footer's.
void draw_panel_words(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                      bool with_time);

/// The time, if all have the same, what the colours mean, and how fast a film plays.
void draw_footer(const Canvas& canvas, const PanelGrid& grid, const RodPicture& first, const PictureStyle& style);

}  // namespace shaken::render
