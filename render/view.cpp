// SPDX-License-Identifier: MIT
#include "render/view.h"

#include <algorithm>
#include <cmath>

namespace shaken::render {

namespace {

/// Whether the view reaches beyond the box.
bool is_whole(const Cell& cell, const PictureStyle& style) {
  return style.whole && style.view == ViewPoint::kTop && style.zoom <= 1 && !style.followed && !style.followed_defect &&
         !cell.walls;
}

}  // namespace

View view_of(const RodPicture& picture, const PictureStyle& style) {
  View view;
  if (is_whole(picture.cell, style)) {
    // A rod whose centre lies in the box reaches at most half a length beyond it, whichever its species.
    double margin = 0;
    for (const BeadRow& beads : picture.cell.species) margin = std::max(margin, beads.reach());
    return {Vec2(-margin, -margin), picture.cell.box_side + 2 * margin, 0};
  }
  view.side = picture.cell.box_side / std::max(style.zoom, 1.0);
  view.period = picture.cell.walls ? 0 : picture.cell.box_side;
  if (const std::optional<std::size_t> rod = followed_rod(picture.frame, style)) {
    view.corner = picture.frame.position[*rod].head<2>() - Vec2(view.side, view.side) / 2;
  } else if (style.followed_defect && picture.found.followed) {
    view.corner = *picture.found.followed - Vec2(view.side, view.side) / 2;
  } else if (style.zoom > 1) {
    view.corner = style.focus * picture.cell.box_side - Vec2(view.side, view.side) / 2;
  }
  return view;
}

std::optional<std::size_t> followed_rod(const Frame& frame, const PictureStyle& style) {
  if (!style.followed || static_cast<std::size_t>(*style.followed) >= frame.position.size()) return std::nullopt;
  return static_cast<std::size_t>(*style.followed);
}

bool is_in_view(const RodPicture& picture, const PictureStyle& style, const Vec2& point) {
  if (style.view != ViewPoint::kTop) return true;
  bool is_seen = false;
  for_images(view_of(picture, style), point, 0, [&](const Vec2&) { is_seen = true; });
  return is_seen;
}

View box_in(const RodPicture& picture, const PictureStyle& style) {
  const View view = view_of(picture, style);
  if (!is_whole(picture.cell, style)) return {Vec2(0, 0), view.side, view.period};
  return {-view.corner, picture.cell.box_side, 0};
}

}  // namespace shaken::render
