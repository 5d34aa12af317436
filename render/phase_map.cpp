// SPDX-License-Identifier: MIT
#include "render/phase_map.h"

#include <algorithm>
#include <cmath>

#include "render/colourings.h"
#include "render/legend.h"

namespace shaken::render {

MapLayout map_layout(const PhaseMap& map, const PictureStyle& style) {
  MapLayout layout;
  layout.unit = std::max(std::min(style.width, style.height) / 720.0, 0.7);
  const double u = layout.unit, gap = std::round(8 * u), margin = 16 * u;
  const double left = style.caption ? (map.y.title.empty() ? margin : 80 * u) : margin;
  const double below = style.caption ? 60 * u : margin, above = style.legend ? 66 * u : margin;
  const auto columns = static_cast<double>(map.x.values.size()), rows = static_cast<double>(map.y.values.size());
  const double width = (style.width - left - margin + gap) / columns - gap;
  const double height = (style.height - above - below + gap) / rows - gap;
  layout.side = static_cast<int>(std::floor(std::min(width, height)));
  layout.step = layout.side + static_cast<int>(gap);
  const double all_wide = columns * layout.step - gap, all_high = rows * layout.step - gap;
  layout.cells = {std::round(left + (style.width - left - margin - all_wide) / 2),
                  std::round(above + (style.height - above - below - all_high) / 2), all_wide, all_high};
  if (style.legend) layout.legend = {layout.cells.x, layout.cells.y - 32 * u, std::min(all_wide, 260 * u), 10 * u};
  return layout;
}

void draw_map_words(const Canvas& canvas, const MapLayout& layout, const PhaseMap& map, const PictureStyle& style) {
  const double u = layout.unit, side = layout.side;
  const PageColours colours = page_colours(style.theme);
  cairo_t* cr = canvas.cairo();
  for (const PhaseMap::Cell& cell : map.cells) {
    const Vec2 at = layout.corner(cell);
    if (!cell.picture) {
      canvas.colour(colours.faint);
      const std::string word = "no frame yet";
      const double size = 14 * u;
      canvas.text(at.x() + side / 2, at.y() + side / 2 + 5 * u, word,
                  size * std::min(1.0, 0.9 * side / canvas.text_width(word, size)), Canvas::Align::kCentre);
    }
    canvas.colour(colours.ink);
    cairo_set_line_width(cr, 1);
    cairo_rectangle(cr, at.x() - 0.5, at.y() - 0.5, side + 1, side + 1);
    cairo_stroke(cr);
  }
  if (style.caption) {
    canvas.colour(colours.ink);
    for (std::size_t i = 0; i < map.x.values.size(); ++i) {
      canvas.text(layout.corner({i, 0, {}}).x() + side / 2, layout.cells.bottom() + 22 * u, map.x.values[i], 15 * u,
                  Canvas::Align::kCentre);
    }
    canvas.text(layout.cells.x + layout.cells.width / 2, layout.cells.bottom() + 46 * u, map.x.title, 17 * u,
                Canvas::Align::kCentre);
    for (std::size_t j = 0; j < map.y.values.size(); ++j) {
      canvas.text(layout.cells.x - 8 * u, layout.corner({0, j, {}}).y() + side / 2 + 5 * u, map.y.values[j], 15 * u,
                  Canvas::Align::kRight);
    }
    canvas.text(layout.cells.x - 8 * u, layout.cells.y - 10 * u, map.y.title, 17 * u, Canvas::Align::kRight);
  }
  const auto shown =
      std::find_if(map.cells.begin(), map.cells.end(), [](const PhaseMap::Cell& cell) { return cell.picture; });
  if (!style.legend || shown == map.cells.end() || !has_scale(*shown->picture, style)) return;
  const Colouring& colouring = colouring_of(*shown->picture, style);
  draw_colour_bar(canvas, layout.legend, u, colouring, range_of(colouring, style), style);
  canvas.text(layout.legend.x, layout.legend.y - 6 * u, title_of(colouring), 13 * u);
}

}  // namespace shaken::render
