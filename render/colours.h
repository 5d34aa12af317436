#pragma once

#include "base/palettes.h"
#include "render/style.h"

namespace shaken::render {

/// The local order S under the director field: that of the floor where S = 1, dark where S = 0.
Colour order_background(double order, Theme theme);

/// The colours around the rods.
struct PageColours {
  Colour page;   ///< outside the box
  Colour floor;  ///< the base plate
  Colour ink;    ///< text and lines
  Colour faint;  ///< secondary text and lines
  Colour walls;  ///< what lies beyond the side walls
};
PageColours page_colours(Theme theme);
/// The same, with the ground that the style has in place of the theme's.
PageColours ground_colours(const PictureStyle& style);

}  // namespace shaken::render
