#include "render/picture_layout.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shaken::render {
namespace {

constexpr double kNarrow = 320;  // in units; narrower panels stack what others put side by side

void place_box(Layout& layout, double x, double y, double side) {
  layout.box_x = static_cast<int>(std::lround(x));
  layout.box_y = static_cast<int>(std::lround(y));
  layout.box_side = std::max(1, static_cast<int>(std::floor(side)));
}

/// Cuts a rectangle of the given height off the top (or, if negative, off the bottom) of `rest`.
Rect cut(Rect& rest, double height) {
  Rect piece = rest;
  piece.height = std::abs(height);
  if (height > 0) {
    rest.y += height;
  } else {
    piece.y = rest.bottom() + height;
  }
  rest.height -= std::abs(height);
  return piece;
}

bool has_ground_key(const PictureStyle& style) {
  return (style.mark_defects && style.tracks > 0) || (style.background == Background::kOrder && style.rods > 0);
}

void fill_column(Layout& layout, Rect panel, const PictureStyle& style, const Contents& contents) {
  const double u = layout.unit;
  if (style.scale_bar) layout.scale_bar = cut(panel, -34 * u);
  if (style.legend && has_ground_key(style)) {
    if (style.scale_bar) cut(panel, -16 * u);
    layout.ground = cut(panel, panel.width < kNarrow * u ? -44 * u : -22 * u);
  }
  if (style.mark_defects) {
    cut(panel, layout.ground.width > 0 ? -8 * u : style.scale_bar ? -16 * u : 0);
    layout.key = cut(panel, panel.width < kNarrow * u ? -56 * u : -22 * u);
  }
  if (style.legend && contents.species > 0) {
    if (style.scale_bar || style.mark_defects) cut(panel, -12 * u);
    layout.species = cut(panel, -22 * u * contents.species);
  }
  if (style.caption) {
    if (contents.label) layout.label = cut(panel, 47 * u);
    layout.numbers = cut(panel, 112 * u);
    cut(panel, 10 * u);
  }
  // What is left is shared by the plots, of which the last ones are left out if there is no room.
  std::vector<Rect*> plots;
  if (style.legend && contents.scale) plots.push_back(&layout.legend);
  if (style.caption && contents.history) plots.push_back(&layout.history);
  if (style.inset != Inset::kNone) plots.push_back(&layout.inset);
  if (plots.empty()) return;
  const double room = panel.height - 14 * u, gap = 12 * u, least = 80 * u;
  const auto height_of = [&](std::size_t n) {
    return (room - gap * static_cast<double>(n - 1)) / static_cast<double>(n);
  };
  while (plots.size() > 1 && height_of(plots.size()) < least) plots.pop_back();
  const double height = std::min(230 * u, height_of(plots.size()));
  if (height < 34 * u) return;
  layout.is_inset_on_rods = plots.back() != &layout.inset;
  std::rotate(plots.begin(), plots.begin() + 1, plots.end());  // the legend stands below the others
  for (Rect* plot : plots) {
    *plot = cut(panel, height);
    cut(panel, gap);
  }
}

/// Words and plots side by side.
void fill_strip(Layout& layout, Rect panel, const PictureStyle& style, const Contents& contents) {
  const double u = layout.unit;
  if (style.caption && contents.label) layout.label = cut(panel, 34 * u);
  const double gap = 30 * u;
  const double column = (panel.width - 2 * gap) / 3;
  Rect left = panel;
  left.width = column;
  Rect middle = left;
  middle.x += column + gap;
  Rect right = middle;
  right.x += column + gap;
  if (style.caption) layout.numbers = left;
  if (style.legend && contents.scale) layout.legend = middle;
  if (style.scale_bar) layout.scale_bar = cut(right, -34 * u);
  if (style.legend && contents.species > 0) layout.species = cut(right, 22 * u * contents.species);
  if (style.mark_defects) {
    cut(right, 10 * u);
    layout.key = cut(right, 50 * u);
  }
}

/// The same one below the other, for pictures too narrow for that: as high as kStacked.
constexpr double kStacked = 420;
void fill_stack(Layout& layout, Rect panel, const PictureStyle& style, const Contents& contents) {
  const double u = layout.unit;
  panel.height = kStacked * u;
  if (style.caption && contents.label) layout.label = cut(panel, 44 * u);
  if (style.caption) layout.numbers = cut(panel, 112 * u);
  if (style.scale_bar) layout.scale_bar = cut(panel, -34 * u);
  if (style.mark_defects) {
    cut(panel, -12 * u);
    layout.key = cut(panel, -22 * u);
  }
  if (style.legend && contents.species > 0) {
    cut(panel, -8 * u);
    layout.species = cut(panel, -22 * u * contents.species);
  }
  cut(panel, 10 * u);
  cut(panel, -14 * u);
  if (style.legend && contents.scale) layout.legend = panel;
}

}  // namespace

void place_inset(Layout& layout, const PictureStyle& style) {
  const double u = layout.unit, edge = std::round(10 * u);
  const bool is_stage = layout.box_side == 0;
  const double width = is_stage ? layout.stage_width : layout.box_side,
               height = is_stage ? layout.stage_height : layout.box_side;
  const double right = is_stage ? width : layout.box_x + width, top = is_stage ? 0 : layout.box_y;
  // Large enough to be read, and not so large that it hides the rods.
  const double w = std::max(150 * u, std::min(0.38 * height, 300 * u)), h = std::max(112 * u, 0.66 * w);
  if (style.inset == Inset::kNone || layout.inset.width > 0 || w > 0.75 * width || h > 0.75 * height) return;
  layout.inset = {right - edge - w, top + edge, w, h};
}

Layout layout_of(const PictureStyle& style, const Contents& contents) {
  Layout layout;
  const double width = style.width, height = style.height;
  layout.unit = std::max(std::min(width, height) / 720, 0.7);  // below that, letters could not be read
  const double margin = std::round(24 * layout.unit);

  if (!style.caption && !style.legend) {
    const double side = std::min(width, height);
    place_box(layout, (width - side) / 2, (height - side) / 2, side);
    const double edge = 16 * layout.unit;
    if (style.scale_bar) {
      layout.scale_bar = {layout.box_x + edge, layout.box_y + side - edge - 34 * layout.unit, 0.4 * side,
                          34 * layout.unit};
      layout.is_bar_on_rods = true;
    }
  } else if (width >= 1.25 * height) {
    const double least_panel = 250 * layout.unit;
    const double side = std::min(height - 2 * margin, width - 3 * margin - least_panel);
    const double room = width - side - 3 * margin;
    const double panel = std::min(room, 480 * layout.unit);
    // Rods and words stand together in the middle of a picture that is wider than both.
    const double left = std::max(margin, (width - side - 2 * margin - panel) / 2);
    place_box(layout, left, (height - side) / 2, side);
    fill_column(layout, {left + side + 1.5 * margin, margin, panel, height - 2 * margin}, style, contents);
  } else {
    const bool is_narrow =
        width < 600 * layout.unit && height - 3 * margin - kStacked * layout.unit >= width - 2 * margin;
    const double strip = is_narrow ? kStacked * layout.unit
                                   : (contents.label && style.caption ? 170 : 136) * layout.unit +
                                         22 * layout.unit * std::max(0, contents.species - 1);
    const double side = std::min(width - 2 * margin, height - 3 * margin - strip);
    const double curve = 130 * layout.unit;
    const bool room_for_curve = style.caption && contents.history && height - 4 * margin - side - strip >= curve;
    const double all = side + margin + strip + (room_for_curve ? margin + curve : 0);
    const double y = std::max(margin, (height - all) / 2);
    place_box(layout, (width - side) / 2, y, side);
    Rect below{margin, y + side + margin, width - 2 * margin, all - side - margin};
    if (room_for_curve) {
      layout.history = cut(below, -curve);
      cut(below, -margin);
    }
    (is_narrow ? fill_stack : fill_strip)(layout, below, style, contents);
  }
  place_inset(layout, style);
  return layout;
}

Layout stage_layout_of(const PictureStyle& style, const Contents& contents) {
  Layout layout;
  layout.unit = std::max(std::min(style.width, style.height) / 720.0, 0.7);
  const double u = layout.unit, margin = std::round(24 * u);
  const bool has_strip = style.caption || style.legend || style.scale_bar;
  const double strip = has_strip ? std::min(206 * u, 0.6 * style.height) : 0;
  layout.stage_width = style.width;
  layout.stage_height = style.height - static_cast<int>(std::lround(strip));
  place_inset(layout, style);
  if (!has_strip) return layout;
  const double gap = 40 * u, width = style.width - 2 * margin - 2 * gap;
  Rect left{margin, layout.stage_height + 14 * u, 0.36 * width, strip - 38 * u};
  const Rect middle{left.right() + gap, left.y, 0.40 * width, left.height};
  Rect right{middle.right() + gap, left.y, 0.24 * width, left.height};
  if (style.caption && contents.label) layout.label = cut(left, 42 * u);
  if (style.caption) layout.numbers = left;
  if (style.legend && contents.scale) layout.legend = middle;
  if (style.scale_bar) layout.scale_bar = cut(right, -34 * u);
  if (style.legend && contents.species > 0) layout.species = cut(right, 22 * u * contents.species);
  return layout;
}

}  // namespace shaken::render
