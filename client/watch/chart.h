#pragma once

#include <span>
#include <string>
#include <vector>

namespace shaken::client {

/// The part of the plane that a chart shows, and its size on the terminal.
struct ChartFrame {
  int width = 60;   ///< columns, axis included
  int height = 10;  ///< lines, axis included
  double x_min = 0;
  double x_max = 1;
  double y_min = 0;
  double y_max = 1;
  std::string x_unit{};  ///< written behind the last number of the x axis
};

/// A line through the points (x, y) in order, in braille dots (2 x 4 per character), with a y axis at the left and an
/// x axis below. Points outside the frame are drawn at its edge; one that is not finite interrupts the line.
/// Returns `height` lines of at most `width` columns; none if the frame is smaller than 12 x 3 or has no extent.
std::vector<std::string> line_chart(std::span<const double> x, std::span<const double> y, const ChartFrame& frame);

}  // namespace shaken::client
