#include "render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "render/colourings.h"
#include "render/colours.h"
#include "render/curve.h"

namespace shaken::render {
namespace {

constexpr double kRadians = kPi / 180;  // in a degree

/// Where the values of a picture's rods lie.
struct Histogram {
  std::vector<double> share;                ///< of the rods, in each of equal bins
  bool is_below = false, is_above = false;  ///< whether the outer bins hold values beyond them
  bool is_empty = true;

  Histogram(const RodPicture& picture, const Colouring& colouring, const Vec2& range) {
    std::vector<double> values;
    for (std::size_t i = 0; i < picture.n_rods(); ++i) {
      if (const double value = colouring.value(picture, i); !std::isnan(value)) values.push_back(value);
    }
    // As fine as the number of rods allows: so that a bar's own scatter stays small.
    share.assign(values.size() < 200 ? 18 : values.size() < 1000 ? 36 : 60, 0.0);
    is_empty = values.empty();
    const auto bins = static_cast<double>(share.size());
    for (const double value : values) {
      const double bin = std::floor((value - range.x()) / (range.y() - range.x()) * bins);
      is_below = is_below || bin < 0;
      is_above = is_above || value > range.y();
      share[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1))] += 1 / static_cast<double>(values.size());
    }
  }
  double most() const { return *std::max_element(share.begin(), share.end()); }
};

/// A line without head or tail: an arrow at both ends.
void draw_axis(const Canvas& canvas, double x, double y, double angle, double unit) {
  cairo_t* cr = canvas.cairo();
  cairo_save(cr);
  cairo_translate(cr, x, y);
  for (const double turn : {0.0, kPi}) {
    cairo_save(cr);
    cairo_rotate(cr, turn - angle);
    canvas.line(0, 0, 12 * unit, 0, 1.6 * unit);
    cairo_move_to(cr, 18 * unit, 0);
    cairo_line_to(cr, 9 * unit, 4 * unit);
    cairo_line_to(cr, 9 * unit, -4 * unit);
    cairo_close_path(cr);
    cairo_fill(cr);
    cairo_restore(cr);
  }
  cairo_restore(cr);
}

/// Smaller where there is no room, but never too small to be read: then it is cut short.
void draw_title(const Canvas& canvas, const Rect& place, double unit, std::string title, double width) {
  constexpr double kLeast = 0.8;
  double size = 13 * unit;
  size *= std::clamp(width / canvas.text_width(title, size), kLeast, 1.0);
  for (std::size_t end = title.find_last_of(' '); canvas.text_width(title, size) > width && end != std::string::npos;
       end = title.find_last_of(' ', end - 1)) {
    title = title.substr(0, end) + " \u2026";
    if (end == 0) break;
  }
  canvas.text(place.x, place.y + 12 * unit, title, size);
}

/// Where there is no room for how many rods have which colour: the colours alone.
void draw_narrow_legend(const Canvas& canvas, const Rect& place, double unit, const Colouring& colouring,
                        const Vec2& range, const PictureStyle& style) {
  const PageColours colours = page_colours(style.theme);
  canvas.colour(colours.ink);
  draw_title(canvas, place, unit, colouring.title, place.width);
  draw_colour_bar(canvas, {place.x, place.y + 20 * unit, place.width, 10 * unit}, unit, colouring, range, style);
}

void draw_line_legend(const Canvas& canvas, const Rect& place, double unit, const Histogram& histogram,
                      const Findings& found, const FilmAxes& axes, const Colouring& colouring, const Vec2& range,
                      const PictureStyle& style) {
  const PageColours colours = page_colours(style.theme);
  constexpr double kLeast = 28;  // units; lower bars say nothing
  if (place.height < (kLeast + 62) * unit) return draw_narrow_legend(canvas, place, unit, colouring, range, style);
  const bool is_relative = std::string_view(colouring.name) == "layers";
  canvas.colour(colours.ink);
  const std::string title = title_of(colouring);
  draw_title(canvas, place, unit, title + ", % of rods", place.width - (is_relative ? 44 * unit : 0));
  if (is_relative && !histogram.is_empty) {
    draw_axis(canvas, place.right() - 18 * unit, place.y + 10 * unit, found.director_angle, unit);
  }

  const double above = 28 * unit, gap = 4 * unit, bar = 10 * unit, words = 20 * unit, left = 26 * unit;
  const Rect plot{place.x + left, place.y + above, place.width - left, place.height - above - gap - bar - words};
  const double most = std::max({histogram.most(), axes.share, 1e-3});
  // Upwards to the tick at or above the highest bar.
  const double step = tick_step(100 * most, plot.height < 60 * unit ? 1 : 3);
  const double top = std::ceil(100 * most / step - 1e-9) * step;
  for (const double percent : ticks(0, top, step)) {
    const double y = plot.bottom() - percent / top * plot.height;
    canvas.colour(colours.faint, percent == 0 ? 0.9 : 0.3);
    canvas.line(plot.x, y, plot.right(), y, unit);
    canvas.colour(colours.ink);
    canvas.text(plot.x - 6 * unit, y + 4 * unit, tick_text(percent), 12 * unit, Canvas::Align::kRight);
  }
  const auto bins = static_cast<int>(histogram.share.size());
  const double width = plot.width / bins;
  const auto height_of = [&](int i) { return histogram.share[static_cast<std::size_t>(i)] * 100 / top * plot.height; };
  for (int i = 0; i < bins; ++i) {
    if (height_of(i) <= 0) continue;
    canvas.colour(colouring.colour(range.x() + (i + 0.5) / bins * (range.y() - range.x()), range, style.palette));
    canvas.fill({plot.x + i * width, plot.bottom() - height_of(i), width, height_of(i)});
  }
  // The bars' outline keeps pale ones visible on a white page.
  cairo_t* cr = canvas.cairo();
  for (int i = 0; i < bins; ++i) {
    if (height_of(i) <= 0) continue;
    cairo_rectangle(cr, plot.x + i * width, plot.bottom() - height_of(i), width, height_of(i));
  }
  canvas.colour(colours.faint, 0.8);
  cairo_set_line_width(cr, 0.6 * unit);
  cairo_stroke(cr);

  draw_colour_bar(canvas, {plot.x, plot.bottom() + gap, plot.width, bar}, unit, colouring, range, style,
                  histogram.is_below, histogram.is_above);
}

/// Half a circle of 180 degrees, or a whole one of 360.
void draw_circle_legend(const Canvas& canvas, const Rect& place, double unit, const Histogram& histogram,
                        const Findings& found, const FilmAxes& axes, const Colouring& colouring, const Vec2& range,
                        const PictureStyle& style) {
  const PageColours colours = page_colours(style.theme);
  constexpr double kLeast = 40;  // units; a smaller rose cannot be read
  if (place.height < (kLeast + 46) * unit) return draw_narrow_legend(canvas, place, unit, colouring, range, style);
  const double most = std::max({histogram.most(), axes.share, 1e-9});
  const bool is_half = colouring.scale == Scale::kHalfTurn;
  const double turn = range.y() * kRadians;

  const double title = 28 * unit, words = 18 * unit;
  canvas.colour(colours.ink);
  draw_title(canvas, place, unit, std::string(colouring.title) + ", and how many rods have it", place.width);
  const double room = place.height - title - words - (is_half ? 0 : words);
  const double outer = std::max(std::min(is_half ? room : room / 2, place.width / 2 - 30 * unit), 10 * unit);
  const double inner = 0.84 * outer, rose = 0.78 * outer;
  const double x = place.x + place.width / 2, y = place.y + title + (is_half ? 8 * unit : words) + outer;
  cairo_t* cr = canvas.cairo();

  const int shades = is_half ? 180 : 360;
  for (int i = 0; i < shades; ++i) {
    const double from = i * turn / shades;
    // Each piece reaches a little under the next, so no seam shows.
    const double to = std::min((i + 1.5) * turn / shades, turn);
    canvas.colour(colouring.colour((i + 0.5) / shades * range.y(), range, style.palette));
    cairo_arc_negative(cr, x, y, outer, -from, -to);
    cairo_arc(cr, x, y, inner, -to, -from);
    cairo_close_path(cr);
    cairo_fill(cr);
  }
  const auto bins = static_cast<int>(histogram.share.size());
  for (int i = 0; i < bins; ++i) {
    // The area of a sector, not its radius, shows the share.
    const double radius = rose * std::sqrt(histogram.share[static_cast<std::size_t>(i)] / most);
    canvas.colour(colouring.colour((i + 0.5) / bins * range.y(), range, style.palette));
    cairo_move_to(cr, x, y);
    cairo_arc_negative(cr, x, y, radius, -i * turn / bins, -(i + 1) * turn / bins);
    cairo_close_path(cr);
    cairo_fill(cr);
  }
  constexpr double kLeastOrder = 0.2;  // below that a few hundred rods have a mean axis by chance
  if (is_half && !histogram.is_empty && found.order >= kLeastOrder) {
    // The director, drawn over the upper half.
    const double angle = found.director_angle < 0 ? found.director_angle + kPi : found.director_angle;
    canvas.colour(colours.ink);
    canvas.line(x, y, x + outer * std::cos(angle), y - outer * std::sin(angle), 1.6 * unit);
    canvas.text(x + (outer + 12 * unit) * std::cos(angle), y - (outer + 12 * unit) * std::sin(angle) + 4 * unit, "N",
                13 * unit, Canvas::Align::kCentre, true);
  }
  canvas.colour(colours.faint);
  if (is_half) canvas.line(x - outer, y, x + outer, y, unit);
  canvas.colour(colours.ink);
  if (is_half) {
    canvas.text(x + outer - 0.08 * outer, y + 15 * unit, "0\u00b0", 12 * unit, Canvas::Align::kCentre);
    canvas.text(x - outer + 0.08 * outer, y + 15 * unit, "180\u00b0", 12 * unit, Canvas::Align::kCentre);
    return;
  }
  canvas.text(x + outer + 5 * unit, y + 4 * unit, "0\u00b0", 12 * unit);
  canvas.text(x, y - outer - 5 * unit, "90\u00b0", 12 * unit, Canvas::Align::kCentre);
  canvas.text(x - outer - 5 * unit, y + 4 * unit, "180\u00b0", 12 * unit, Canvas::Align::kRight);
  canvas.text(x, y + outer + 14 * unit, "270\u00b0", 12 * unit, Canvas::Align::kCentre);
}

/// The background as if it were a colouring: S where the rods are.
const Colouring& background_scale(Theme theme) {
  static const auto make = [](auto colour) {
    Colouring scale = *find_colouring("order");
    scale.title = "Local order S at the rods";
    scale.colour = colour;
    return scale;
  };
  static const Colouring light =
      make([](double s, const Vec2&, Palette) { return order_background(s, Theme::kLight); });
  static const Colouring print =
      make([](double s, const Vec2&, Palette) { return order_background(s, Theme::kPrint); });
  static const Colouring dark = make([](double s, const Vec2&, Palette) { return order_background(s, Theme::kDark); });
  return theme == Theme::kDark ? dark : theme == Theme::kPrint ? print : light;
}

bool shows_background_alone(const PictureStyle& style) {
  return style.rods <= 0 && style.background == Background::kOrder;
}

}  // namespace

std::string title_of(const Colouring& colouring) {
  const std::string_view unit = colouring.unit;
  return unit.empty() || unit == "\u00b0" ? colouring.title : fmt::format("{} ({})", colouring.title, unit);
}

void draw_colour_bar(const Canvas& canvas, const Rect& bar, double unit, const Colouring& colouring, const Vec2& range,
                     const PictureStyle& style, bool is_below, bool is_above) {
  const PageColours colours = page_colours(style.theme);
  const bool is_angle = std::string_view(colouring.unit) == "\u00b0";
  const int shades = 240;
  for (int i = 0; i < shades; ++i) {
    canvas.colour(colouring.colour(range.x() + (i + 0.5) / shades * (range.y() - range.x()), range, style.palette));
    const double from = std::round(bar.x + i * bar.width / shades);
    canvas.fill({from, bar.y, std::round(bar.x + (i + 1) * bar.width / shades) - from, bar.height});
  }
  const int most_ticks = std::max(2, static_cast<int>(bar.width / (56 * unit)));
  for (const double value : ticks(range.x(), range.y(), tick_step(range.y() - range.x(), most_ticks, is_angle))) {
    const double x = bar.x + (value - range.x()) / (range.y() - range.x()) * bar.width;
    canvas.colour(colours.ink);
    canvas.line(x, bar.bottom(), x, bar.bottom() + 4 * unit, unit);
    const bool is_first = value <= range.x(), is_last = value >= range.y();
    const bool is_low = is_first && is_below, is_high = is_last && is_above;
    const std::string beyond = is_low ? "\u2264" : is_high ? "\u2265" : "";
    canvas.text(x, bar.bottom() + 16 * unit, beyond + tick_text(value, is_angle ? colouring.unit : ""), 12 * unit,
                is_last    ? Canvas::Align::kRight
                : is_first ? Canvas::Align::kLeft
                           : Canvas::Align::kCentre);
  }
}

bool has_scale(const RodPicture& picture, const PictureStyle& style) {
  return shows_background_alone(style) || colouring_of(picture, style).scale != Scale::kNames;
}

double highest_bar(const RodPicture& picture, const PictureStyle& style) {
  if (shows_background_alone(style)) {
    const Colouring& scale = background_scale(style.theme);
    return Histogram(picture, scale, scale.range).most();
  }
  const Colouring& colouring = colouring_of(picture, style);
  return colouring.scale == Scale::kNames ? 0 : Histogram(picture, colouring, range_of(colouring, style)).most();
}

void draw_legend(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                 const PictureStyle& style) {
  const bool is_background = shows_background_alone(style);
  const Colouring& colouring = is_background ? background_scale(style.theme) : colouring_of(picture, style);
  if (colouring.scale == Scale::kNames) return;
  const Vec2 range = is_background ? colouring.range : range_of(colouring, style);
  (colouring.scale == Scale::kLine ? draw_line_legend : draw_circle_legend)(
      canvas, place, unit, Histogram(picture, colouring, range), picture.found, picture.captions.axes, colouring, range,
      style);
}

}  // namespace shaken::render
