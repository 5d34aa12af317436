// SPDX-License-Identifier: MIT
#include "render/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/colourings.h"
#include "render/curve.h"
#include "render/inset.h"
#include "render/legend.h"
#include "render/marks.h"
#include "render/plane_layers.h"
#include "render/view.h"

namespace shaken::render {
namespace {

void draw_frame(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                const Palette& colours) {
  cairo_t* cr = canvas.cairo();
  const double line = std::max(1.0, std::round(1.2 * layout.unit));
  const View box = box_in(picture, style);
  const double scale = layout.box_side / view_of(picture, style).side, side = box.side * scale;
  const double x = layout.box_x + box.corner.x() * scale,
               y = layout.box_y + layout.box_side - box.corner.y() * scale - side;
  cairo_rectangle(cr, x - line / 2, y - line / 2, side + line, side + line);
  canvas.colour(colours.ink);
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

/// The label on one line, smaller if need be, cut short if that does not help.
void draw_label(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const Palette& colours) {
  const double u = layout.unit, width = layout.label.width;
  std::string label = picture.label;
  double size = 18 * u;
  if (const double needed = canvas.text_width(label, size, true); needed > width) {
    size = std::max(12 * u, size * width / needed);
  }
  while (!label.empty() && canvas.text_width(label, size, true) > width) {
    label = label.substr(0, label.find_last_of(' ') == std::string::npos ? 0 : label.find_last_of(' '));
  }
  canvas.colour(colours.ink);
  canvas.text(layout.label.x, layout.label.y + 15 * u, label, size, Canvas::Align::kLeft, true);
  if (picture.subtitle.empty() || layout.label.height < 38 * u) return;
  canvas.colour(colours.faint);
  canvas.text(layout.label.x, layout.label.y + 34 * u, picture.subtitle, 13 * u);
}

/// Six numbers in two rows, each under its name; five of spheres, which have no S.
void draw_numbers(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const Palette& colours) {
  const double u = layout.unit;
  const Rect& place = layout.numbers;
  struct Number {
    const char* name;
    std::string value;
  };
  // In slow motion the last digit should be seen to move.
  const int digits = picture.playback > 0 && picture.playback < 0.05 ? 4 : 2;
  const bool has_axes = picture.cell.has_axes();
  std::vector<Number> numbers{{"time", fmt::format("{:.{}f} s", picture.time, digits)}};
  if (has_axes) numbers.push_back({"order S", fmt::format("{:.3f}", picture.order)});
  numbers.push_back(
      {has_axes || picture.cell.species.size() > 1 ? "rods" : "spheres", fmt::format("{}", picture.n_rods())});
  numbers.push_back({has_axes ? "rod length" : "diameter", fmt::format("{:.4g} mm", picture.rod_length())});
  numbers.push_back({"packing \u03c6", fmt::format("{:.2f}", picture.area_fraction())});
  numbers.push_back({"gap", fmt::format("{:.4g} mm", picture.cell.gap)});
  // Three columns where they fit, otherwise two.
  const int n = static_cast<int>(numbers.size());
  const int columns = place.width >= 240 * u ? 3 : 2, rows = (n + columns - 1) / columns;
  const double shrink = std::min(1.0, place.width / (columns * 100 * u));
  const double pitch = std::min(58 * u, (place.height + 12 * u) / rows);
  for (int i = 0; i < n; ++i) {
    const Number& number = numbers[static_cast<std::size_t>(i)];
    const double x = place.x + (i % columns) * place.width / columns;
    const int row = i / columns;
    const double y = place.y + row * pitch;
    canvas.colour(colours.faint);
    canvas.text(x, y + 11 * u, number.name, 12 * u * shrink);
    canvas.colour(colours.ink);
    canvas.text(x, y + (11 + 22 * shrink) * u, number.value, 20 * u * shrink);
  }
}

void draw_key(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const Palette& colours) {
  const double u = layout.unit;
  const auto plus = std::count_if(picture.defects.begin(), picture.defects.end(),
                                  [](const analysis::Defect& defect) { return defect.charge > 0; });
  const auto minus = static_cast<std::ptrdiff_t>(picture.defects.size()) - plus;
  const bool stacked = layout.key.height > 40 * u;
  const double x = layout.key.x, y = layout.key.y + 11 * u;
  const double x2 = stacked ? x : x + layout.key.width / 2, y2 = stacked ? y + 34 * u : y;
  draw_plus_half(canvas, x + 10 * u, y, 0, 0.85 * u);
  draw_minus_half(canvas, x2 + 14 * u, y2, kPi / 2, 0.75 * u);
  canvas.colour(colours.ink);
  canvas.text(x + 46 * u, y + 5 * u, fmt::format("+\u00bd defects: {}", plus), 13 * u);
  canvas.text(x2 + 46 * u, y2 + 5 * u, fmt::format("\u2212\u00bd defects: {}", minus), 13 * u);
}

/// A rod of each species, seen from above in one scale, and how many there are. The first species has no colour of its
/// own.
void draw_species(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                  const Palette& colours) {
  const double u = layout.unit;
  const bool by_name = std::string_view(colouring_of(picture, style).name) == "species";
  const double column = layout.species.width / static_cast<double>(picture.cell.species.size());
  double words = 0;                // room for a number [pixels]
  double longest = 0, widest = 0;  // [mm]
  for (std::size_t species = 0; species < picture.cell.species.size(); ++species) {
    const BeadRow& beads = picture.cell.species[species];
    words = std::max(words, canvas.text_width(fmt::format("{}", picture.count(species)), 13 * u) + 17 * u);
    longest = std::max(longest, beads.length());
    widest = std::max(widest, 2 * *std::max_element(beads.radius.begin(), beads.radius.end()));
  }
  const double scale = std::min((column - words) / longest, 16 * u / widest);  // pixels per mm
  cairo_t* cr = canvas.cairo();
  const double y = layout.species.y + 11 * u;
  for (std::size_t species = 0; species < picture.cell.species.size(); ++species) {
    const BeadRow& beads = picture.cell.species[species];
    const double x = layout.species.x + static_cast<double>(species) * column;
    const double centre = x + scale * (beads.radius.front() - beads.offset.front());
    for (const bool rim : {true, false}) {  // the rim keeps pale rods visible on a white page
      canvas.colour(rim            ? colours.faint
                    : by_name      ? name_colour(species)
                    : species == 0 ? layer_colour(0)
                                   : species_colour(species));
      for (std::size_t i = 0; i < beads.offset.size(); ++i) {
        cairo_new_sub_path(cr);
        cairo_arc(cr, centre + scale * beads.offset[i], y, scale * beads.radius[i] + (rim ? 0.5 : -0.5) * u, 0,
                  2 * kPi);
      }
      cairo_fill(cr);
    }
    canvas.colour(colours.ink);
    canvas.text(x + scale * beads.length() + 7 * u, y + 5 * u, fmt::format("{}", picture.count(species)), 13 * u);
  }
}

void draw_scale_bar(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                    const Palette& colours) {
  const double u = layout.unit;
  const bool is_top = style.view == ViewPoint::kTop;
  const int height = is_top ? layout.box_side : layout.stage_height;
  const double aspect = is_top ? 1 : static_cast<double>(layout.stage_width) / height;
  const double scale = 1 / camera_of(picture, style, aspect).pixel(height);  // pixels per mm
  const double length = round_length(layout.scale_bar.width * (is_top ? 0.6 : 0.5) / scale);
  const double bottom = layout.scale_bar.bottom();
  const char* const words = is_top ? "" : style.view == ViewPoint::kGap ? " at the opening" : " in the middle";
  canvas.colour(colours.ink);
  canvas.fill({layout.scale_bar.x, bottom - 5 * u, length * scale, 5 * u});
  canvas.text(layout.scale_bar.x, bottom - 11 * u, fmt::format("{:g} mm{}", length, words), 14 * u);
  const std::string speed = playback_text(picture.playback);
  if (speed.empty()) return;
  // The sign of playing before the words.
  const double right = layout.scale_bar.right(), size = 14 * u;
  const double left = right - canvas.text_width(speed, size) - 16 * u;
  cairo_t* cr = canvas.cairo();
  cairo_move_to(cr, left, bottom - 10 * u);
  cairo_line_to(cr, left + 9 * u, bottom - 5 * u);
  cairo_line_to(cr, left, bottom);
  cairo_close_path(cr);
  cairo_fill(cr);
  canvas.text(right, bottom, speed, size, Canvas::Align::kRight);
}

}  // namespace

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= length) return digit * power;
  }
  return power;
}

std::string playback_text(double playback) {
  if (!(playback > 0)) return "";
  const double slow = 1 / playback;
  if (std::abs(playback - 1) < 0.005) return "real time";
  // 1/10 where that is what it is, else 0.15.
  if (playback < 1 && std::abs(slow - std::round(slow)) < 0.02 * slow && slow < 1000.5) {
    return fmt::format("1/{:.0f} speed", slow);
  }
  return fmt::format("{:.2g}\u00d7 speed", playback);
}

void draw_time_bar(const Canvas& canvas, const RodPicture& picture, const PictureStyle& style) {
  if (!style.time_bar || picture.film_share < 0) return;
  const Palette colours = palette(style.theme);
  const double height = std::max(3.0, std::round(std::min(style.width, style.height) / 180.0));
  const double width = style.width;
  canvas.colour(colours.faint, 0.35);
  canvas.fill({0, style.height - height, width, height});
  canvas.colour(colours.ink, 0.8);
  canvas.fill({0, style.height - height, std::min(picture.film_share, 1.0) * width, height});
}

void draw_overlay(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  const Palette colours = palette(style.theme);
  if (style.view == ViewPoint::kTop) {
    draw_lines(canvas, layout, picture, style);
    draw_tracks(canvas, layout, picture, style);
    draw_displacements(canvas, layout, picture, style);
    if (style.mark_defects) draw_defects(canvas, layout, picture, style);
    draw_frame(canvas, layout, picture, style, colours);
  }
  if (layout.label.width > 0) draw_label(canvas, layout, picture, colours);
  if (layout.numbers.width > 0) draw_numbers(canvas, layout, picture, colours);
  if (layout.history.width > 0) draw_curve(canvas, layout.history, layout.unit, order_curve(picture), colours);
  if (layout.legend.width > 0) draw_legend(canvas, layout.legend, layout.unit, picture, style);
  if (layout.species.width > 0) draw_species(canvas, layout, picture, style, colours);
  if (layout.key.width > 0) draw_key(canvas, layout, picture, colours);
  if (layout.scale_bar.width > 0) draw_scale_bar(canvas, layout, picture, style, colours);
  if (layout.inset.width > 0) draw_inset(canvas, layout.inset, layout.unit, picture, style);
}

}  // namespace shaken::render
