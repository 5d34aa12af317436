#include "render/inset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/angles.h"
#include "render/colourings.h"
#include "render/curve.h"

namespace shaken::render {
namespace {

const std::vector<Tick> kHalves{{0, "0"}, {0.5, "0.5"}, {1, "1"}};

}  // namespace

Curve order_curve(const RodPicture& picture) {
  const OrderHistory& history = picture.captions.history;
  return {.title = picture.cell.n_species() > 1 ? "Nematic order S of the first species" : "Nematic order S",
          .x = history.time,
          .y = history.order,
          .x_ticks = {{history.start, fmt::format("{:.4g} s", history.start)},
                      {history.end, fmt::format("{:.4g} s", history.end)}},
          .y_ticks = kHalves,
          .dot = Vec2(picture.frame.time, picture.found.order)};
}

Curve angle_curve(const RodPicture& picture) {
  const std::vector<Vec3> directors = picture.cell.of_species(0, picture.frame.director);
  // As fine as the number of rods allows: so that a bin's own scatter stays small.
  analysis::AngleDistribution distribution(directors.size() < 200 ? 18 : 36);
  distribution.accumulate(directors);
  const analysis::AnglePdf pdf = distribution.reduce();
  Curve curve{.title = "P(\u03b8) (1/\u00b0)",
              .x_ticks = {{-90, "\u221290\u00b0"}, {0, "0\u00b0"}, {90, "90\u00b0"}},
              .y_ticks = {},
              .is_area = true};
  for (const double theta : pdf.theta) curve.x.push_back(theta * 180 / kPi);
  for (const double density : pdf.density) curve.y.push_back(density * kPi / 180);
  // +90 and -90 degrees are one angle: the curve goes on from either end to the other.
  const double width = 180 / static_cast<double>(curve.x.size());
  curve.x.insert(curve.x.begin(), curve.x.front() - width / 2);
  curve.x.push_back(curve.x.back() + width / 2);
  const double at_end = (curve.y.front() + curve.y.back()) / 2;
  curve.y.insert(curve.y.begin(), at_end);
  curve.y.push_back(at_end);
  const double most =
      std::max({*std::max_element(curve.y.begin(), curve.y.end()), picture.captions.axes.density, 1 / 180.0});
  const double step = tick_step(most, 3), top = std::ceil(most / step - 1e-9) * step;
  for (const double value : ticks(0, top, step)) curve.y_ticks.push_back({value, tick_text(value)});
  return curve;
}

namespace {

/// An axis that holds all of `values`, from one round number to another.
std::vector<Tick> axis_over(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double span = *high > *low ? *high - *low : std::max(std::abs(*low), 1e-3);
  const double step = tick_step(1.2 * span, 3);
  std::vector<Tick> axis;
  const double first = std::floor((*low - 0.05 * span) / step), last = std::ceil((*high + 0.05 * span) / step);
  for (double k = first; k <= last; ++k) axis.push_back({k * step, tick_text(k * step)});
  return axis;
}

}  // namespace

Curve sweep_curve(const Captions& captions) {
  const SweepMap& map = *captions.sweep;
  const Colouring& order = *find_colouring("order");
  Curve curve;
  curve.title = map.y.empty() ? fmt::format("S over {}", map.x) : fmt::format("{} over {}, by S", map.y, map.x);
  std::vector<double> x{captions.sweep_point.x()}, y{captions.sweep_point.y()};
  Vec2 here = captions.sweep_point;
  for (const SweepMap::Point& point : map.points) {
    x.push_back(point.at.x());
    y.push_back(point.at.y());
    if (map.y.empty() && point.at.x() == here.x()) here.y() = point.order;
    if (map.y.empty() && std::isnan(point.order)) continue;
    curve.dots.push_back({Vec2(point.at.x(), map.y.empty() ? point.order : point.at.y()),
                          std::isnan(point.order) ? page_colours(Theme::kLight).page
                                                  : order.colour(point.order, order.range, Palette::kSafe)});
  }
  curve.x_ticks = axis_over(x);
  curve.y_ticks = map.y.empty() ? kHalves : axis_over(y);
  if (!std::isnan(here.y())) curve.ring = here;
  return curve;
}

bool has_inset(const RodPicture& picture, const PictureStyle& style) {
  switch (style.inset) {
    case Inset::kNone:
      return false;
    case Inset::kOrder:
      return !picture.captions.history.time.empty();
    case Inset::kSweep:
      return picture.captions.sweep != nullptr;
    case Inset::kAngles:
      break;
  }
  return picture.count(0) > 1;
}

void draw_inset(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                const PictureStyle& style, bool is_on_rods) {
  if (!has_inset(picture, style)) return;
  const PageColours colours = page_colours(style.theme);
  if (is_on_rods) {
    canvas.colour(colours.page);
    canvas.fill(place);
    canvas.colour(colours.ink);
    cairo_rectangle(canvas.cairo(), place.x, place.y, place.width, place.height);
    cairo_set_line_width(canvas.cairo(), unit);
    cairo_stroke(canvas.cairo());
  }
  const double edge = is_on_rods ? 8 * unit : 0;
  const Rect inner{place.x + edge, place.y + edge, place.width - 2 * edge, place.height - 1.5 * edge};
  draw_curve(canvas, inner, unit,
             style.inset == Inset::kOrder   ? order_curve(picture)
             : style.inset == Inset::kSweep ? sweep_curve(picture.captions)
                                            : angle_curve(picture),
             colours);
}

}  // namespace shaken::render
