#include "render/colours.h"

#include <algorithm>

namespace shaken::render {

Colour order_background(double order, Theme theme) {
  return blend(no_order_colour(theme == Theme::kDark), page_colours(theme).floor, std::clamp(order, 0.0, 1.0));
}

PageColours page_colours(Theme theme) {
  if (theme == Theme::kDark) {
    return {{0.071, 0.078, 0.094}, {0.11, 0.118, 0.137}, {0.92, 0.925, 0.935}, {0.56, 0.58, 0.62}, {0.21, 0.22, 0.245}};
  }
  const Colour floor = theme == Theme::kPrint ? Colour{1, 1, 1} : Colour{0.965, 0.96, 0.95};
  return {{1, 1, 1}, floor, {0.11, 0.12, 0.14}, {0.45, 0.46, 0.49}, {0.84, 0.845, 0.855}};
}

PageColours ground_colours(const PictureStyle& style) {
  PageColours colours = page_colours(style.theme);
  if (style.ground) colours.page = colours.floor = colours.walls = *style.ground;
  return colours;
}

}  // namespace shaken::render
