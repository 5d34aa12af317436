#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/canvas.h"
#include "render/colours.h"

namespace shaken::render {

/// The least of 1, 2, 5 times a power of ten that cuts `span` into at most `most` pieces; of degrees, of 15, 30,
/// 45, 90.
double tick_step(double span, int most, bool degrees = false);

/// The multiples of `step` in [low, high].
std::vector<double> ticks(double low, double high, double step);

/// A number for an axis, with a real minus sign: "−15°", "0.2".
std::string tick_text(double value, std::string_view unit = "");

/// A mark of an axis.
struct Tick {
  double at;
  std::string text;
};

/// A line over two axes, as small plots beside the rods have it.
struct Curve {
  std::string title{};
  std::vector<double> x{}, y{};            ///< points; the line has a gap where y is NaN
  std::vector<Tick> x_ticks{}, y_ticks{};  ///< increasing; the first and the last are the ends of the axis
  struct Dot {
    Vec2 at;
    Colour colour;
  };
  std::vector<Dot> dots{};     ///< without a line
  std::optional<Vec2> ring{};  ///< round one of them
  std::optional<Vec2> dot{};   ///< the present
  bool is_area = false;        ///< filled down to 0
};

/// Draws it so that title and marks lie within `place`; `unit` as in Layout.
void draw_curve(const Canvas& canvas, const Rect& place, double unit, const Curve& curve, const PageColours& colours);

}  // namespace shaken::render
