#include "render/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/colourings.h"
#include "render/legend.h"
#include "render/overlay.h"

namespace shaken::render {
namespace {

constexpr double kHeadline = 30;  // above a box, in units
constexpr double kBelow = 36;     // for the scale bar
constexpr double kFooter = 54;

}  // namespace

PanelGrid panel_grid(const PictureStyle& style, std::size_t n_panels) {
  PanelGrid grid;
  grid.unit = std::max(std::min(style.width, style.height) / 720.0, 0.7);
  const double u = grid.unit;
  const bool has_words = style.caption || style.legend || style.scale_bar;
  const double margin = has_words ? std::round(16 * u) : std::round(2 * u);
  const double above = style.caption ? kHeadline * u : 0;
  const double below = style.scale_bar || style.caption ? kBelow * u : 0;
  const double footer = style.caption || style.legend ? kFooter * u : 0;
  const auto n = static_cast<double>(n_panels);
  // The number of columns that leaves the largest boxes; the fewest if several do.
  double side = 0, columns = 1;
  for (double c = 1; c <= n; ++c) {
    const double rows = std::ceil(n / c);
    const double width = (style.width - (c + 1) * margin) / c;
    const double height = (style.height - footer - (rows + 1) * margin) / rows - above - below;
    if (std::min(width, height) > side + 0.5) {
      side = std::min(width, height);
      columns = c;
    }
  }
  side = std::max(1.0, std::floor(side));
  const double rows = std::ceil(n / columns);
  const double cell = side + margin, row = above + side + below + margin;
  const double left = (style.width - columns * cell + margin) / 2;
  const double top = std::max(margin, (style.height - footer - rows * row + margin) / 2);
  for (std::size_t i = 0; i < n_panels; ++i) {
    const auto place = static_cast<double>(i);
    const double x = left + std::fmod(place, columns) * cell, y = top + std::floor(place / columns) * row;
    Layout layout;
    layout.unit = u;
    layout.box_x = static_cast<int>(std::lround(x));
    layout.box_y = static_cast<int>(std::lround(y + above));
    layout.box_side = static_cast<int>(side);
    if (style.caption) layout.label = {x, y, side, above};
    // S and the time stand right of the bar.
    if (below > 0) layout.scale_bar = {x, y + above + side, (style.caption ? 0.6 : 1) * side, 30 * u};
    place_inset(layout, style);
    grid.panels.push_back(layout);
  }
  if (footer > 0) {
    const double below_all = std::min(top + rows * row, style.height - footer);
    grid.footer = {left, below_all, columns * cell - margin, footer - 14 * u};
  }
  return grid;
}

bool have_one_time(const RodPicture& picture) {
  constexpr double kShown = 0.005;  // half of the last digit [s]
  return std::all_of(picture.beside.begin(), picture.beside.end(),
                     [&](const RodPicture& other) { return std::abs(other.frame.time - picture.frame.time) < kShown; });
}

void draw_panel_words(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                      bool with_time) {
  RodPicture quiet = picture;
  quiet.beside.clear();
  quiet.captions.playback = 0;
  quiet.captions.subtitle.clear();
  Layout words = layout;
  if (!style.scale_bar) words.scale_bar = {};
  draw_overlay(canvas, words, quiet, style);
  if (!style.caption) return;
  canvas.colour(page_colours(style.theme).ink);
  canvas.text(layout.box_x + layout.box_side, layout.scale_bar.bottom(),
              fmt::format("{}{}{}", with_time ? fmt::format("t = {:.2f} s", picture.frame.time) : "",
                          with_time && picture.cell.has_axes() ? ", " : "",
                          picture.cell.has_axes() ? fmt::format("S = {:.3f}", picture.found.order) : ""),
              14 * layout.unit, Canvas::Align::kRight);
}

void draw_footer(const Canvas& canvas, const PanelGrid& grid, const RodPicture& first, const PictureStyle& style) {
  const double u = grid.unit, bottom = grid.footer.bottom();
  const PageColours colours = page_colours(style.theme);
  if (style.caption) {
    canvas.colour(colours.ink);
    if (have_one_time(first)) {
      canvas.text(grid.footer.x, bottom - 6 * u, fmt::format("t = {:.2f} s", first.frame.time), 20 * u);
    }
    canvas.colour(colours.faint);
    canvas.text(grid.footer.right(), bottom - 6 * u, playback_text(first.captions.playback), 14 * u,
                Canvas::Align::kRight);
  }
  if (!style.legend || !has_scale(first, style)) return;
  const Colouring& colouring = colouring_of(first, style);
  const Vec2 range = range_of(colouring, style);
  const Rect strip{grid.footer.x + 0.4 * grid.footer.width, bottom - 23 * u, 0.3 * grid.footer.width, 10 * u};
  draw_colour_bar(canvas, strip, u, colouring, range, style);
  canvas.text(strip.x + strip.width / 2, strip.y - 5 * u, title_of(colouring), 12 * u, Canvas::Align::kCentre);
}

}  // namespace shaken::render
