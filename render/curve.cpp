#include "render/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shaken::render {

void draw_curve(const Canvas& canvas, const Rect& place, double unit, const Curve& curve, const PageColours& colours) {
  canvas.colour(colours.ink);
  const double size = 13 * unit;
  canvas.text(place.x, place.y + 12 * unit, curve.title,
              size * std::min(1.0, place.width / canvas.text_width(curve.title, size)));
  double left = 26 * unit;
  for (const Tick& tick : curve.y_ticks) left = std::max(left, canvas.text_width(tick.text, 12 * unit) + 6 * unit);
  const Rect plot{place.x + left, place.y + 28 * unit, place.width - left, place.height - 50 * unit};
  const auto along = [](double value, const std::vector<Tick>& ticks) {
    const double low = ticks.front().at, high = ticks.back().at;
    return (value - low) / (high > low ? high - low : 1);
  };
  const auto x_of = [&](double x) { return plot.x + along(x, curve.x_ticks) * plot.width; };
  const auto y_of = [&](double y) { return plot.bottom() - along(y, curve.y_ticks) * plot.height; };

  for (const Tick& tick : curve.y_ticks) {
    canvas.colour(colours.faint, tick.at == 0 ? 0.9 : 0.3);
    canvas.line(plot.x, y_of(tick.at), plot.right(), y_of(tick.at), unit);
    canvas.colour(colours.ink);
    canvas.text(plot.x - 6 * unit, y_of(tick.at) + 4 * unit, tick.text, 12 * unit, Canvas::Align::kRight);
  }
  // Those in between give way to the words of the last.
  double free = plot.x - 100 * unit;
  const double last_begins = plot.right() - canvas.text_width(curve.x_ticks.back().text, 12 * unit);
  for (const Tick& tick : curve.x_ticks) {
    const double half = canvas.text_width(tick.text, 12 * unit) / 2, x = x_of(tick.at), space = 5 * unit;
    const bool is_inner = &tick != &curve.x_ticks.front() && &tick != &curve.x_ticks.back();
    if (is_inner && (x - half < free + space || x + half > last_begins - space)) continue;
    free = &tick == &curve.x_ticks.front() ? x + 2 * half : x + half;
    const bool is_first = &tick == &curve.x_ticks.front(), is_last = &tick == &curve.x_ticks.back();
    canvas.text(x_of(tick.at), plot.bottom() + 16 * unit, tick.text, 12 * unit,
                is_first  ? Canvas::Align::kLeft
                : is_last ? Canvas::Align::kRight
                          : Canvas::Align::kCentre);
  }

  cairo_t* cr = canvas.cairo();
  const Colour ink = diverging_colour(-1);
  std::vector<Vec2> piece;
  const auto draw_piece = [&] {
    if (piece.empty()) return;
    if (curve.is_area) {
      cairo_move_to(cr, piece.front().x(), y_of(0));
      for (const Vec2& p : piece) cairo_line_to(cr, p.x(), p.y());
      cairo_line_to(cr, piece.back().x(), y_of(0));
      canvas.colour(ink, 0.25);
      cairo_fill(cr);
    }
    for (const Vec2& p : piece) cairo_line_to(cr, p.x(), p.y());
    canvas.colour(ink);
    cairo_set_line_width(cr, 1.8 * unit);
    cairo_stroke(cr);
    piece.clear();
  };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (std::isnan(curve.y[i])) {
      draw_piece();
    } else {
      piece.emplace_back(x_of(curve.x[i]), y_of(curve.y[i]));
    }
  }
  draw_piece();
  for (const Curve::Dot& dot : curve.dots) {
    for (const bool rim : {true, false}) {  // which keeps pale ones visible
      canvas.colour(rim ? colours.faint : dot.colour);
      cairo_arc(cr, x_of(dot.at.x()), y_of(dot.at.y()), (rim ? 4 : 3.3) * unit, 0, 2 * kPi);
      cairo_fill(cr);
    }
  }
  if (curve.ring) {
    canvas.colour(colours.ink);
    cairo_set_line_width(cr, 1.6 * unit);
    cairo_arc(cr, x_of(curve.ring->x()), y_of(curve.ring->y()), 6.5 * unit, 0, 2 * kPi);
    cairo_stroke(cr);
  }
  if (!curve.dot) return;
  canvas.colour(ink);
  cairo_arc(cr, x_of(curve.dot->x()), y_of(curve.dot->y()), 4 * unit, 0, 2 * kPi);
  cairo_fill(cr);
}

double tick_step(double span, int most, bool degrees) {
  const double least = span / most;
  if (degrees) {
    for (const double step : {15.0, 30.0, 45.0}) {
      if (step >= least) return step;
    }
    return 90;
  }
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> all;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double k = first; k <= last; ++k) all.push_back(k == 0 ? 0.0 : k * step);
  return all;
}

std::string tick_text(double value, std::string_view unit) {
  return fmt::format("{}{:.6g}{}", value < 0 ? "\u2212" : "", std::abs(value), unit);
}

}  // namespace shaken::render
