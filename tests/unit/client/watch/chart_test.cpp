// SPDX-License-Identifier: MIT
#include "client/watch/chart.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/text.h"

namespace shaken::client {
namespace {

/// The dots alone: without the axis at the left.
std::string dots(const std::string& line) {
  std::size_t bytes = 0;
  for (std::size_t columns = 0; columns < 6 && bytes < line.size(); ++columns) {
    do ++bytes;
    while (bytes < line.size() && (static_cast<unsigned char>(line[bytes]) & 0xC0) == 0x80);
  }
  return line.substr(bytes);
}

TEST(LineChart, ConstantAtTheBottomIsARowOfLowestDots) {
  const std::vector<double> x{0, 1};
  const std::vector<double> y{0, 0};
  const auto chart = line_chart(x, y, {.width = 12, .height = 3, .x_unit = "s"});
  ASSERT_EQ(chart.size(), 3u);
  EXPECT_EQ(dots(chart[0]), "⣀⣀⣀⣀⣀⣀");
  EXPECT_EQ(chart[1], "     └──────");
  EXPECT_EQ(chart[2], "      0  1 s");
}

TEST(LineChart, DiagonalIsTheNearestDotInEachColumn) {
  const std::vector<double> x{0, 1};
  const std::vector<double> y{0, 1};
  const auto chart = line_chart(x, y, {.width = 12, .height = 4});
  ASSERT_EQ(chart.size(), 4u);
  // 12 x 8 dots. Column c has its dot 7 c / 11 above the lowest line, rounded: 0 1 1 2 3 3 | 4 4 5 6 6 7.
  EXPECT_EQ(dots(chart[0]), "   ⣀⠔⠊");
  EXPECT_EQ(dots(chart[1]), "⡠⠔⠉   ");
}

TEST(LineChart, ValueOutsideIsDrawnAtTheEdgeAndNanInterrupts) {
  const std::vector<double> x{0, 0.5, 1};
  const std::vector<double> high{7, NAN, 7};
  const auto chart = line_chart(x, high, {.width = 12, .height = 3});
  ASSERT_EQ(chart.size(), 3u);
  EXPECT_EQ(dots(chart[0]), "⠁    ⠈");
}

TEST(LineChart, EveryLineFits) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 1000; ++i) {
    x.push_back(i * 0.01);
    y.push_back(0.5 + 0.5 * std::sin(i * 0.02));
  }
  for (int width = 12; width < 100; width += 7) {
    const auto chart = line_chart(x, y, {.width = width, .height = 9, .x_max = 10, .x_unit = "s"});
    ASSERT_EQ(chart.size(), 9u);
    for (const std::string& line : chart) EXPECT_LE(display_width(line), static_cast<std::size_t>(width)) << line;
  }
}

TEST(LineChart, TooSmallOrEmptyFramesGiveNothing) {
  const std::vector<double> x{0, 1};
  EXPECT_TRUE(line_chart(x, x, {.width = 11, .height = 5}).empty());
  EXPECT_TRUE(line_chart(x, x, {.width = 40, .height = 2}).empty());
  EXPECT_TRUE(line_chart(x, x, {.width = 40, .height = 5, .x_max = 0}).empty());
  EXPECT_TRUE(line_chart(x, x, {.width = 40, .height = 5, .y_min = 2, .y_max = 2}).empty());
  EXPECT_EQ(line_chart({}, {}, {.width = 40, .height = 5}).size(), 5u);
}

}  // namespace
}  // namespace shaken::client
