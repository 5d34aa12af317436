// SPDX-License-Identifier: MIT
#include "render/legend.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/periodic.h"
#include "render/colours.h"

namespace shaken::render {
namespace {

constexpr double kDegree = kPi / 180;

/// Counts of `angles` in equal bins over [low, high), scaled to a largest of 1; angles outside are left out.
std::vector<double> scaled_histogram(const std::vector<double>& angles, double low, double high, int bins) {
  std::vector<double> counts(static_cast<std::size_t>(bins));
  for (const double angle : angles) {
    const double bin = std::floor((angle - low) / (high - low) * bins);
    if (bin >= 0 && bin < bins) counts[static_cast<std::size_t>(bin)] += 1;
  }
  const double most = *std::max_element(counts.begin(), counts.end());
  if (most > 0) {
    for (double& count : counts) count /= most;
  }
  return counts;
}

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

void draw_layer_legend(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                       const Palette& colours) {
  constexpr double kReach = 45;  // degrees on either side
  constexpr int kBins = 60;
  std::vector<double> angles;
  for (const Vec3& n : picture.first_directors())
    angles.push_back(analysis::fold_half_turn(std::atan2(n.y(), n.x()) - picture.director_angle));
  const std::vector<double> counts = scaled_histogram(angles, -kReach * kDegree, kReach * kDegree, kBins);

  const double title = 20 * unit, bar = 11 * unit, ticks = 22 * unit;
  canvas.colour(colours.ink);
  canvas.text(place.x, place.y + 12 * unit, "Angle to the director", 13 * unit);
  if (!angles.empty()) {
    draw_axis(canvas, place.right() - 18 * unit, place.y + 10 * unit, picture.director_angle, unit);
  }
  const Rect plot{place.x, place.y + title + 8 * unit, place.width, place.height - title - 8 * unit - bar - ticks};
  const double step = plot.width / kBins;
  for (int i = 0; i < kBins; ++i) {
    const double theta = (-kReach + (i + 0.5) * 2 * kReach / kBins) * kDegree;
    const Colour colour = layer_colour(theta);
    const double x = plot.x + i * step;
    const double height = counts[static_cast<std::size_t>(i)] * plot.height;
    canvas.colour(colour);
    canvas.fill({x, plot.bottom() - height, step, height});
  }
  // The bars' outline keeps the pale ones in the middle visible on a white page.
  cairo_t* cr = canvas.cairo();
  cairo_move_to(cr, plot.x, plot.bottom());
  for (int i = 0; i < kBins; ++i) {
    const double y = plot.bottom() - counts[static_cast<std::size_t>(i)] * plot.height;
    cairo_line_to(cr, plot.x + i * step, y);
    cairo_line_to(cr, plot.x + (i + 1) * step, y);
  }
  cairo_line_to(cr, plot.right(), plot.bottom());
  canvas.colour(colours.faint);
  cairo_set_line_width(cr, 0.9 * unit);
  cairo_stroke(cr);

  // The colour bar, continuous.
  constexpr int kShades = 180;
  for (int i = 0; i < kShades; ++i) {
    canvas.colour(layer_colour((-kReach + (i + 0.5) * 2 * kReach / kShades) * kDegree));
    const double left = std::round(plot.x + i * plot.width / kShades);
    const double right = std::round(plot.x + (i + 1) * plot.width / kShades);
    canvas.fill({left, plot.bottom(), right - left, bar});
  }
  const int spacing = place.width >= 300 * unit ? 15 : 45;
  for (int degrees = -45; degrees <= 45; degrees += spacing) {
    const double x = plot.x + (degrees + kReach) / (2 * kReach) * plot.width;
    canvas.colour(colours.ink);
    canvas.line(x, plot.bottom() + bar, x, plot.bottom() + bar + 4 * unit, unit);
    const auto align = degrees == -45  ? Canvas::Align::kLeft
                       : degrees == 45 ? Canvas::Align::kRight
                                       : Canvas::Align::kCentre;
    const std::string text = (degrees < 0 ? "\u2212" : "") + std::to_string(std::abs(degrees)) + "\u00b0";
    canvas.text(x, plot.bottom() + bar + 17 * unit, text, 12 * unit, align);
  }
}

void draw_wheel_legend(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                       const Palette& colours) {
  constexpr int kBins = 60;
  std::vector<double> angles;
  for (const Vec3& n : picture.first_directors()) {
    const double angle = analysis::fold_half_turn(std::atan2(n.y(), n.x()));
    angles.push_back(angle < 0 ? angle + kPi : angle);
  }
  const std::vector<double> counts = scaled_histogram(angles, 0, kPi, kBins);

  const double title = 28 * unit, words = 18 * unit;
  canvas.colour(colours.ink);
  canvas.text(place.x, place.y + 12 * unit, "Angle in the box", 13 * unit);
  const double outer = std::min(place.height - title - words, place.width / 2 - 30 * unit);
  const double inner = 0.84 * outer, rose = 0.78 * outer;
  const double x = place.x + place.width / 2, y = place.y + title + 8 * unit + outer;
  cairo_t* cr = canvas.cairo();

  constexpr int kShades = 180;
  for (int i = 0; i < kShades; ++i) {
    const double from = i * kPi / kShades;
    // Each piece reaches a little under the next, so no seam shows.
    const double to = std::min((i + 1.5) * kPi / kShades, kPi);
    canvas.colour(wheel_colour((i + 0.5) * kPi / kShades));
    cairo_arc_negative(cr, x, y, outer, -from, -to);
    cairo_arc(cr, x, y, inner, -to, -from);
    cairo_close_path(cr);
    cairo_fill(cr);
  }
  for (int i = 0; i < kBins; ++i) {
    // The area of a sector, not its radius, shows the count.
    const double radius = rose * std::sqrt(counts[static_cast<std::size_t>(i)]);
    canvas.colour(wheel_colour((i + 0.5) * kPi / kBins));
    cairo_move_to(cr, x, y);
    cairo_arc_negative(cr, x, y, radius, -i * kPi / kBins, -(i + 1) * kPi / kBins);
    cairo_close_path(cr);
    cairo_fill(cr);
  }
  if (!angles.empty()) {
    // The director, drawn over the upper half.
    const double angle = picture.director_angle < 0 ? picture.director_angle + kPi : picture.director_angle;
    canvas.colour(colours.ink);
    canvas.line(x, y, x + outer * std::cos(angle), y - outer * std::sin(angle), 1.6 * unit);
    canvas.text(x + (outer + 12 * unit) * std::cos(angle), y - (outer + 12 * unit) * std::sin(angle) + 4 * unit, "N",
                13 * unit, Canvas::Align::kCentre, true);
  }
  canvas.colour(colours.faint);
  canvas.line(x - outer, y, x + outer, y, unit);
  canvas.colour(colours.ink);
  canvas.text(x + outer - 0.08 * outer, y + 15 * unit, "0\u00b0", 12 * unit, Canvas::Align::kCentre);
  canvas.text(x - outer + 0.08 * outer, y + 15 * unit, "180\u00b0", 12 * unit, Canvas::Align::kCentre);
}

}  // namespace

void draw_legend(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                 const PictureStyle& style) {
  const Palette colours = palette(style.theme);
  if (style.colouring == Colouring::kLayers) {
    draw_layer_legend(canvas, place, unit, picture, colours);
  } else {
    draw_wheel_legend(canvas, place, unit, picture, colours);
  }
}

}  // namespace shaken::render
