#include "render/view.h"

#include <algorithm>

namespace shaken::render {

namespace {

/// Whether the view reaches beyond the box.
bool is_whole(const Cell& cell, const PictureStyle& style) {
  return style.whole && style.view == ViewPoint::kTop && style.zoom <= 1 && !style.followed && !style.followed_defect &&
         !cell.walls;
}

}  // namespace

View view_of(const RodPicture& picture, const PictureStyle& style) {
  const Box& box = picture.cell.box;
  View view;
  const auto look_at = [&](const Vec2& middle) { view.corner = middle - Vec2(view.side, view.side) / 2; };
  if (is_whole(picture.cell, style)) {
    // A rod whose centre lies in the box reaches at most half a length beyond it, whichever its species.
    double margin = 0;
    for (const BeadRow& beads : picture.cell.shapes) margin = std::max(margin, beads.reach());
    view.side = box.longer() + 2 * margin;
    view.corner = Vec2(-margin, -margin) - (Vec2(box.longer(), box.longer()) - box.sides()) / 2;
    return view;
  }
  view.side = box.longer() / std::max(style.zoom, 1.0);
  view.period = picture.cell.period();
  if (const std::optional<std::size_t> rod = followed_rod(picture.frame, style)) {
    look_at(picture.frame.position[*rod].head<2>());
  } else if (style.followed_defect && picture.found.followed) {
    look_at(*picture.found.followed);
  } else {
    const Vec2 middle(0.5, 0.5);
    look_at((style.zoom > 1 ? style.focus : middle).cwiseProduct(box.sides()));
  }
  return view;
}

std::optional<std::size_t> followed_rod(const Frame& frame, const PictureStyle& style) {
  if (!style.followed) return std::nullopt;
  return frame.rod_of(static_cast<std::size_t>(*style.followed));
}

bool is_in_view(const RodPicture& picture, const PictureStyle& style, const Vec2& point) {
  if (style.view != ViewPoint::kTop) return true;
  bool is_seen = false;
  for_images(view_of(picture, style), point, 0, [&](const Vec2&) { is_seen = true; });
  return is_seen;
}

Framed framed_in(const RodPicture& picture, const PictureStyle& style) {
  const View view = view_of(picture, style);
  const Box& box = picture.cell.box;
  const bool is_on_the_box =
      style.zoom <= 1 && !followed_rod(picture.frame, style) && !(style.followed_defect && picture.found.followed);
  if (is_whole(picture.cell, style) || (is_on_the_box && box.x() != box.y())) return {-view.corner, box.sides()};
  return {Vec2(0, 0), Vec2(view.side, view.side)};
}

}  // namespace shaken::render
