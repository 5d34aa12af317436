// SPDX-License-Identifier: MIT
#include "render/view.h"

#include <algorithm>

namespace shaken::render {

View view_of(const RodPicture& picture, const PictureStyle& style) {
  View view;
  view.side = picture.box_side / std::max(style.zoom, 1.0);
  view.period = picture.walls ? 0 : picture.box_side;
  if (style.followed && static_cast<std::size_t>(*style.followed) < picture.n_rods()) {
    const auto rod = static_cast<std::size_t>(*style.followed);
    view.corner = picture.position[rod].head<2>() - Vec2(view.side, view.side) / 2;
  } else if (style.zoom > 1) {
    view.corner = style.focus * picture.box_side - Vec2(view.side, view.side) / 2;
  }
  return view;
}

}  // namespace shaken::render
