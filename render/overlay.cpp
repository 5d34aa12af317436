#include "render/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "analysis/order.h"
#include "base/text.h"
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
                const PageColours& colours) {
  cairo_t* cr = canvas.cairo();
  const double line = std::max(1.0, std::round(1.2 * layout.unit));
  const Framed box = framed_in(picture, style);
  const double scale = layout.box_side / view_of(picture, style).side;
  const Vec2 sides = scale * box.sides;
  const double x = layout.box_x + box.corner.x() * scale,
               y = layout.box_y + layout.box_side - box.corner.y() * scale - sides.y();
  cairo_rectangle(cr, x - line / 2, y - line / 2, sides.x() + line, sides.y() + line);
  canvas.colour(colours.ink);
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

/// The label on one line, smaller if need be, cut short if that does not help.
void draw_label(const Canvas& canvas, const Layout& layout, const Captions& captions, const PageColours& colours) {
  const double u = layout.unit, width = layout.label.width;
  std::string label = captions.label;
  double size = 18 * u;
  if (const double needed = canvas.text_width(label, size, true); needed > width) {
    size = std::max(12 * u, size * width / needed);
  }
  if (canvas.text_width(label, size, true) > width) {
    const auto cut = [&] { return label + " \u2026"; };
    // between settings, if it is made of some, so that none loses its unit
    const std::string between = label.find(", ") != std::string::npos ? ", " : " ";
    while (!label.empty() && canvas.text_width(cut(), size, true) > width) {
      const std::size_t last = label.rfind(between);
      label.resize(last == std::string::npos ? 0 : last);
    }
    label = label.empty() ? "" : cut();
  }
  canvas.colour(colours.ink);
  canvas.text(layout.label.x, layout.label.y + 15 * u, label, size, Canvas::Align::kLeft, true);
  if (captions.subtitle.empty() || layout.label.height < 38 * u) return;
  canvas.colour(colours.faint);
  canvas.text(layout.label.x, layout.label.y + 34 * u, captions.subtitle, 13 * u);
}

/// Names and values in rows, each value under its name.
void draw_numbers(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                  const PageColours& colours) {
  const double u = layout.unit;
  const Rect& place = layout.numbers;
  const std::vector<Number> numbers = numbers_of(picture, style);
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

void draw_key(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
              const PageColours& colours) {
  const double u = layout.unit;
  const bool stacked = layout.key.height > 40 * u;
  const double x = layout.key.x, y = layout.key.y + 11 * u;
  const double x2 = stacked ? x : x + layout.key.width / 2, y2 = stacked ? y + 34 * u : y;
  draw_plus_half(canvas, x + 10 * u, y, 0, 0.85 * u);
  draw_minus_half(canvas, x2 + 14 * u, y2, kPi / 2, 0.75 * u);
  const double size = 13 * u;
  const auto write = [&](double left, double baseline, const std::string& text) {
    const double room = (stacked ? layout.key.width : layout.key.width / 2) - 46 * u;
    canvas.colour(colours.ink);
    canvas.text(left + 46 * u, baseline + 5 * u, text, size * std::min(1.0, room / canvas.text_width(text, size)));
  };
  write(x, y, defects_text(picture, style, 0.5));
  write(x2, y2, defects_text(picture, style, -0.5));
}

/// What the tracks and the ground under pale rods mean.
void draw_ground_key(const Canvas& canvas, const Layout& layout, const PictureStyle& style,
                     const PageColours& colours) {
  const double u = layout.unit, size = 13 * u;
  double y = layout.ground.y + 11 * u;
  const bool stacked = layout.ground.height > 40 * u;
  double x = layout.ground.x;
  if (style.mark_defects && style.tracks > 0) {
    for (const double charge : {1.0, -1.0}) {
      canvas.colour(diverging_colour(charge));
      canvas.line(x, y - 3 * charge * u, x + 22 * u, y - 3 * charge * u, 3.5 * u);
    }
    canvas.colour(colours.ink);
    canvas.text(x + 46 * u, y + 5 * u, fmt::format("their last {:g} s", style.tracks), size);
    if (stacked) {
      y += 22 * u;
    } else {
      x += layout.ground.width / 2;
    }
  }
  if (style.background != Background::kOrder || style.rods <= 0) return;  // without rods it is the legend's
  const Rect strip{x, y - 5 * u, 40 * u, 10 * u};
  constexpr int kSteps = 40;
  for (int k = 0; k < kSteps; ++k) {
    canvas.colour(order_background((k + 0.5) / kSteps, style.theme));
    canvas.fill({strip.x + k * u, strip.y, 1.3 * u, strip.height});
  }
  canvas.colour(colours.faint);
  cairo_rectangle(canvas.cairo(), strip.x, strip.y, strip.width, strip.height);
  cairo_set_line_width(canvas.cairo(), 0.6 * u);
  cairo_stroke(canvas.cairo());
  canvas.colour(colours.ink);
  canvas.text(strip.x + 46 * u, y + 5 * u, "ground: S from 0 to 1", size);
}

/// A rod of each species, seen from above in one scale, and what is to be said of it; pale where the scale colours it.
void draw_species(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                  const PageColours& colours) {
  const double u = layout.unit;
  const Colouring& colouring = colouring_of(picture, style);
  const bool by_name = std::string_view(colouring.name) == "species";
  double longest = 0, widest = 0;  // [mm]
  const Cell& cell = picture.cell;
  for (std::size_t species = 0; species < cell.n_species(); ++species) {
    const BeadRow& beads = cell.mean_of_species(species);
    longest = std::max(longest, beads.length());
    widest = std::max(widest, 2 * *std::max_element(beads.radius.begin(), beads.radius.end()));
  }
  const double row = layout.species.height / static_cast<double>(cell.n_species());
  const double room = std::min(0.4 * layout.species.width, 110 * u);
  const double scale = std::min(room / longest, 0.75 * row / widest);  // pixels per mm
  cairo_t* cr = canvas.cairo();
  for (std::size_t species = 0; species < cell.n_species(); ++species) {
    const BeadRow& beads = cell.mean_of_species(species);
    std::size_t example = 0;
    while (example + 1 < picture.n_rods() && cell.species_of(example) != species) ++example;
    const bool has_scale = !std::isnan(colouring.value(picture, example));
    const double y = layout.species.y + (static_cast<double>(species) + 0.5) * row;
    const double centre = layout.species.x + scale * (beads.radius.front() - beads.offset.front());
    for (const bool rim : {true, false}) {  // the rim keeps pale rods visible on a white page
      canvas.colour(rim         ? colours.faint
                    : by_name   ? name_colour(species)
                    : has_scale ? layer_colour(0)
                                : rod_colour(picture, example, colouring, range_of(colouring, style), style.palette));
      for (std::size_t i = 0; i < beads.offset.size(); ++i) {
        cairo_new_sub_path(cr);
        cairo_arc(cr, centre + scale * beads.offset[i], y, scale * beads.radius[i] + (rim ? 0.5 : -0.5) * u, 0,
                  2 * kPi);
      }
      cairo_fill(cr);
    }
    canvas.colour(colours.ink);
    const double x = layout.species.x + scale * longest + 10 * u, size = 13 * u;
    const std::string text = species_text(cell, picture.frame, species);
    canvas.text(x, y + 5 * u, text, size * std::min(1.0, (layout.species.right() - x) / canvas.text_width(text, size)));
  }
}

void draw_scale_bar(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style,
                    const PageColours& colours) {
  const double u = layout.unit;
  const bool is_top = style.view == ViewPoint::kTop;
  const int height = is_top ? layout.box_side : layout.stage_height;
  const double aspect = is_top ? 1 : static_cast<double>(layout.stage_width) / height;
  const double scale = 1 / camera_of(picture, style, aspect).pixel(height);  // pixels per mm
  const double length = round_length(layout.scale_bar.width * (is_top ? 0.6 : 0.5) / scale);
  const double bottom = layout.scale_bar.bottom();
  const char* const words = is_top ? "" : style.view == ViewPoint::kGap ? " at the opening" : " in the middle";
  if (layout.is_bar_on_rods) {
    const std::string text = fmt::format("{:g} mm", length);
    const double edge = 8 * u, wide = std::max(length * scale, canvas.text_width(text, 14 * u));
    canvas.colour(colours.page, 0.9);
    canvas.fill({layout.scale_bar.x - edge, bottom - 25 * u - edge, wide + 2 * edge, 25 * u + 2 * edge});
  }
  canvas.colour(colours.ink);
  canvas.fill({layout.scale_bar.x, bottom - 5 * u, length * scale, 5 * u});
  canvas.text(layout.scale_bar.x, bottom - 11 * u, fmt::format("{:g} mm{}", length, words), 14 * u);
  const std::string speed = playback_text(picture.captions.playback);
  if (speed.empty() || layout.is_bar_on_rods) return;
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

std::vector<Number> numbers_of(const RodPicture& picture, const PictureStyle& style) {
  // In slow motion the last digit should be seen to move.
  const int digits = picture.captions.playback > 0 && picture.captions.playback < 0.05 ? 4 : 2;
  const Cell& cell = picture.cell;
  const bool has_axes = cell.has_axes(), is_mixture = cell.n_species() > 1;
  std::vector<Number> numbers{{"time", fmt::format("{:.{}f} s", picture.frame.time, digits)}};
  // Of a mixture S and lengths belong to its species, beside which they stand (species_text).
  if (has_axes && !is_mixture) numbers.push_back({"order S", fmt::format("{:.3f}", picture.found.order)});
  std::size_t seen = 0;
  for (const Vec3& at : picture.frame.position) seen += is_in_view(picture, style, at.head<2>()) ? 1 : 0;
  numbers.push_back(
      {is_mixture ? "bodies"
       : has_axes ? "rods"
                  : "spheres",
       seen == picture.n_rods() ? fmt::format("{}", seen) : fmt::format("{}/{}", seen, picture.n_rods())});
  if (!is_mixture) {
    numbers.push_back({has_axes ? "length \u2113" : "diameter d", picture.length_text()});
  }
  numbers.push_back({"packing \u03c6", fmt::format("{:.2f}", picture.area_fraction())});
  numbers.push_back({"gap w", fmt::format("{:.4g} mm", cell.gap)});
  return numbers;
}

std::string defects_text(const RodPicture& picture, const PictureStyle& style, double charge) {
  std::size_t all = 0, seen = 0;
  for (const analysis::Defect& defect : picture.found.defects) {
    if (defect.charge * charge < 0) continue;
    ++all;
    seen += is_in_view(picture, style, defect.position) ? 1 : 0;
  }
  const char* const name = charge > 0 ? "+\u00bd defects" : "\u2212\u00bd defects";
  return seen == all ? fmt::format("{}: {}", name, all) : fmt::format("{}: in view {} of {}", name, seen, all);
}

std::string species_text(const Cell& cell, const Frame& frame, std::size_t species) {
  const std::vector<Vec3> of_it = cell.of_species(species, frame.director);
  const std::size_t n = of_it.size();
  if (!cell.mean_of_species(species).has_axis()) return fmt::format("{} {}", n, n == 1 ? "sphere" : "spheres");
  const double order = analysis::nematic_order(std::span<const Vec3>(of_it)).order;
  return fmt::format("{} {}, S = {:.3f}", n, n == 1 ? "rod" : "rods", order);
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

void draw_time_bar(const Canvas& canvas, const Captions& captions, const PictureStyle& style) {
  if (!style.time_bar || captions.film_share < 0) return;
  const PageColours colours = page_colours(style.theme);
  const double height = std::max(3.0, std::round(std::min(style.width, style.height) / 180.0));
  const double width = style.width;
  canvas.colour(colours.faint, 0.35);
  canvas.fill({0, style.height - height, width, height});
  canvas.colour(colours.ink, 0.8);
  canvas.fill({0, style.height - height, std::min(captions.film_share, 1.0) * width, height});
}

void draw_overlay(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  const PageColours colours = page_colours(style.theme);
  if (style.view == ViewPoint::kTop) {
    draw_lines(canvas, layout, picture, style);
    draw_tracks(canvas, layout, picture, style);
    draw_displacements(canvas, layout, picture, style);
    if (style.mark_defects) draw_defects(canvas, layout, picture, style);
    draw_frame(canvas, layout, picture, style, colours);
  }
  if (layout.label.width > 0) draw_label(canvas, layout, picture.captions, colours);
  if (layout.numbers.width > 0) draw_numbers(canvas, layout, picture, style, colours);
  if (layout.history.width > 0) draw_curve(canvas, layout.history, layout.unit, order_curve(picture), colours);
  if (layout.legend.width > 0) draw_legend(canvas, layout.legend, layout.unit, picture, style);
  if (layout.species.width > 0) draw_species(canvas, layout, picture, style, colours);
  if (layout.key.width > 0) draw_key(canvas, layout, picture, style, colours);
  if (layout.ground.width > 0) draw_ground_key(canvas, layout, style, colours);
  if (layout.scale_bar.width > 0) draw_scale_bar(canvas, layout, picture, style, colours);
  if (layout.inset.width > 0) draw_inset(canvas, layout.inset, layout.unit, picture, style, layout.is_inset_on_rods);
}

}  // namespace shaken::render
