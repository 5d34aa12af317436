#include "client/watch/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/text.h"
#include "client/watch/cells.h"

namespace shaken::client {
namespace {

/// A grid of dots, each 2 x 4 of them one braille character.
class DotGrid {
 public:
  DotGrid(int columns, int lines)
      : columns_(columns),
        lines_(lines),
        cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines), 0) {}
  int width() const { return 2 * columns_; }
  int height() const { return 4 * lines_; }

  void set(int x, int y) { cells_[static_cast<std::size_t>((y / 4) * columns_ + x / 2)] |= kBrailleDots[y % 4][x % 2]; }

  /// Bresenham's line.
  void line(int x0, int y0, int x1, int y1) {
    const int dx = std::abs(x1 - x0);
    const int dy = -std::abs(y1 - y0);
    const int step_x = x0 < x1 ? 1 : -1;
    const int step_y = y0 < y1 ? 1 : -1;
    for (int error = dx + dy;;) {
      set(x0, y0);
      if (x0 == x1 && y0 == y1) return;
      const int doubled = 2 * error;
      if (doubled >= dy) {
        error += dy;
        x0 += step_x;
      }
      if (doubled <= dx) {
        error += dx;
        y0 += step_y;
      }
    }
  }

  std::string text(int line) const {
    std::string text;
    for (int column = 0; column < columns_; ++column) {
      const std::uint8_t bits = cells_[static_cast<std::size_t>(line * columns_ + column)];
      append_utf8(text, bits == 0 ? U' ' : kNoDots + bits);  // a blank as a space, so that it copies as one
    }
    return text;
  }

 private:
  int columns_;
  int lines_;
  std::vector<std::uint8_t> cells_;
};

int to_dot(double value, double min, double max, int dots) {
  const double fraction = std::clamp((value - min) / (max - min), 0.0, 1.0);
  return static_cast<int>(std::lround(fraction * (dots - 1)));
}

}  // namespace

std::vector<std::string> line_chart(std::span<const double> x, std::span<const double> y, const ChartFrame& frame) {
  static constexpr int kAxisColumns = 6;  // "0.50 ┤"
  if (frame.width < 12 || frame.height < 3) return {};
  if (!(frame.x_max > frame.x_min) || !(frame.y_max > frame.y_min)) return {};

  const int lines = frame.height - 2;
  DotGrid grid(frame.width - kAxisColumns, lines);
  bool has_previous = false;
  int previous_x = 0;
  int previous_y = 0;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      has_previous = false;
      continue;
    }
    const int dot_x = to_dot(x[i], frame.x_min, frame.x_max, grid.width());
    const int dot_y = grid.height() - 1 - to_dot(y[i], frame.y_min, frame.y_max, grid.height());
    if (has_previous) {
      grid.line(previous_x, previous_y, dot_x, dot_y);
    } else {
      grid.set(dot_x, dot_y);
    }
    has_previous = true;
    previous_x = dot_x;
    previous_y = dot_y;
  }

  std::vector<std::string> chart;
  for (int line = 0; line < lines; ++line) {
    // Numbers at the top, the bottom and, where one line is exactly half-way, in the middle.
    std::string label;
    if (line == 0)
      label = fmt::format("{:.2f}", frame.y_max);
    else if (line == lines - 1)
      label = fmt::format("{:.2f}", frame.y_min);
    else if (2 * line == lines - 1)
      label = fmt::format("{:.2f}", 0.5 * (frame.y_min + frame.y_max));
    chart.push_back(fmt::format("{:>4} {}", label, label.empty() ? "│" : "┤") + grid.text(line));
  }
  std::string axis = "     └";
  for (int i = 0; i < frame.width - kAxisColumns; ++i) axis += "─";
  chart.push_back(axis);
  const std::string first = number_text(frame.x_min);
  const std::string last = number_text(frame.x_max) + (frame.x_unit.empty() ? "" : " " + frame.x_unit);
  const int between = frame.width - kAxisColumns - static_cast<int>(first.size() + display_width(last));
  chart.push_back("      " + first + std::string(static_cast<std::size_t>(std::max(1, between)), ' ') + last);
  return chart;
}

}  // namespace shaken::client
