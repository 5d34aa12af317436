#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "base/files.h"
#include "base/palettes.h"
#include "base/text.h"
#include "client/watch/chart.h"
#include "client/watch/rod_cells.h"

namespace shaken::client {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr RodStyle kDots{.colouring = Colouring::kLayers, .grain = Grain::kBraille, .in_colour = false};
constexpr RodStyle kBlocks{.colouring = Colouring::kLayers, .grain = Grain::kBlocks};

/// A box of 10 mm with rods of 4.5 mm and radius 0.25 mm: 10 x 5 cells have 2 samples per mm.
RodFrame frame_of(std::vector<proto::RodPose> rods) {
  RodFrame frame;
  frame.cell.box = 10;
  frame.outlines = {{.half_length = 2, .middle = 0.25, .end = 0.25}};
  frame.rods = std::move(rods);
  return frame;
}

CellGrid drawn(const RodFrame& frame, const RodStyle& style, const RodView& view = {}, int columns = 10, int lines = 5,
               const std::vector<DefectMark>& defects = {}) {
  CellGrid grid(columns, lines);
  draw_rods(frame, defects, view, style, {0, 0, columns, lines}, grid);
  return grid;
}

int n_dots(const CellGrid& grid) {
  int n = 0;
  for (int line = 0; line < grid.lines(); ++line) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (const char32_t glyph = grid.at(column, line).glyph; glyph >= 0x2800) n += std::popcount(glyph - 0x2800U);
    }
  }
  return n;
}

TEST(RodCells, ARodAlongXInTheMiddle) {
  // Its samples are 5 to 14 of row 9, which is the second of the four of line 2.
  const CellGrid grid = drawn(frame_of({{5, 5.25, 0, 0}}), kDots);
  EXPECT_EQ(grid.text(2), "  ⠐⠒⠒⠒⠒⠂");
  for (const int line : {0, 1, 3, 4}) EXPECT_EQ(grid.text(line), "") << line;
}

TEST(RodCells, ARodAlongYIsHighWhereYIsLarge) {
  // Samples 9 of column x = 4.75, rows 1 to 10: from y = 9.25 down to 4.75.
  const CellGrid grid = drawn(frame_of({{4.75, 7, kPi / 2, 0}}), kDots);
  EXPECT_EQ(grid.text(0), "    ⢰");
  EXPECT_EQ(grid.text(1), "    ⢸");
  EXPECT_EQ(grid.text(2), "    ⠸");
  EXPECT_EQ(grid.text(3), "");
}

TEST(RodCells, ARodAcrossThePeriodicBorderIsOnBothSides) {
  EXPECT_EQ(drawn(frame_of({{0, 5.25, 0, 0}}), kDots).text(2), "⠒⠒⠂    ⠐⠒⠒");
  // Over a corner there are four pieces, together one rod.
  const int whole = n_dots(drawn(frame_of({{5, 5, 0.6, 0}}), kDots));
  const CellGrid corner = drawn(frame_of({{0, 0, 0.6, 0}}), kDots);
  EXPECT_EQ(n_dots(corner), whole);
  EXPECT_NE(corner.text(0), "");
  EXPECT_NE(corner.text(4), "");
}

TEST(RodCells, BetweenWallsNothingIsRepeated) {
  RodFrame frame = frame_of({{0, 5.25, 0, 0}});
  frame.cell.walls.emplace();
  frame.cell.walls->arena = Arena::kSquare;
  frame.cell.walls->size = 40;  // out of sight
  EXPECT_EQ(drawn(frame, kDots).text(2), "⠒⠒⠂");
  // Nor does the view come back on the other side: half of it is empty.
  EXPECT_EQ(drawn(frame, kDots, {.x = 0}).text(2), "     ⠒⠒⠂");
}

TEST(RodCells, AChannelIsRepeatedAlongItself) {
  RodFrame frame = frame_of({{0, 5.25, 0, 0}});
  frame.cell.walls = SideWalls{.arena = Arena::kChannel, .size = 40};  // out of sight
  EXPECT_EQ(drawn(frame, kDots).text(2), "⠒⠒⠂    ⠐⠒⠒");
  frame.rods = {{5, 0, 0, 0}};
  EXPECT_EQ(drawn(frame, kDots).text(0), "") << "but not across";
}

TEST(RodCells, WallsAreDrawn) {
  RodFrame frame = frame_of({});
  frame.cell.walls.emplace();
  frame.cell.walls->arena = Arena::kDisc;
  frame.cell.walls->size = 8;
  const CellGrid grid = drawn(frame, kBlocks);
  EXPECT_EQ(grid.at(5, 2).back, ink_of(kFloorTone));
  EXPECT_NE(grid.at(1, 2), grid.at(5, 2)) << "4 mm left of the middle";
  frame.cell.walls = SideWalls{.arena = Arena::kEllipse, .size = 4, .length = 8};
  EXPECT_NE(drawn(frame, kBlocks).at(1, 2), grid.at(5, 2)) << "at a tip";
  frame.cell.walls->arena = Arena::kWedge;
  EXPECT_NE(drawn(frame, kBlocks).at(1, 2), grid.at(5, 2)) << "at the wide end";
}

TEST(RodCells, TheViewMovesRoundThePeriodicBox) {
  const CellGrid middle = drawn(frame_of({{5, 5.25, 0, 0}}), kDots);
  const CellGrid moved = drawn(frame_of({{0, 0.25, 0, 0}}), kDots, {.x = 0, .y = 0});
  for (int line = 0; line < 5; ++line) EXPECT_EQ(moved.text(line), middle.text(line));
}

TEST(RodCells, ZoomEnlarges) {
  const RodFrame frame = frame_of({{5, 5, 0.3, 0}});
  const int once = n_dots(drawn(frame, kDots, {}, 100, 50));
  const int twice = n_dots(drawn(frame, kDots, {.zoom = 2}, 100, 50));
  // A capsule of 4 x 0.5 mm and two half discs, with 20 and 40 samples per mm.
  const double area = 4 * 0.5 + kPi * 0.25 * 0.25;
  EXPECT_NEAR(once, area * 20 * 20, 0.03 * area * 400);
  EXPECT_NEAR(twice, area * 40 * 40, 0.02 * area * 1600);
}

TEST(RodCells, RodsTaperAndSteepOnesAreShort) {
  RodFrame frame = frame_of({{5, 5, 0.3, 0}});
  frame.outlines = {{.half_length = 2, .middle = 0.5, .end = 0.1}};
  const double area = 2 * 2 * (0.5 + 0.1) + kPi * 0.01;
  EXPECT_NEAR(n_dots(drawn(frame, kDots, {}, 200, 100)), area * 1600, 0.02 * area * 1600);
  frame = frame_of({{5, 5, 0.3, 1}});
  EXPECT_NEAR(n_dots(drawn(frame, kDots, {}, 200, 100)), kPi * 0.0625 * 1600, 0.05 * kPi * 0.0625 * 1600);
}

// A post at the left border is seen at the right one too, but not where walls end the box.
TEST(RodCells, PostsAreDrawnWithTheirImages) {
  RodFrame frame = frame_of({});
  frame.cell.posts = {.diameter = 6, .centres = {Vec2(0, 5)}};
  const CellGrid periodic = drawn(frame, kBlocks);
  const Ink post = ink_of(kWallTone), floor = ink_of(kFloorTone);
  const auto colour = [](const ScreenCell& cell) { return cell.glyph == U' ' ? cell.back : cell.fore; };
  EXPECT_EQ(colour(periodic.at(0, 2)), post);
  EXPECT_EQ(colour(periodic.at(9, 2)), post);
  EXPECT_EQ(colour(periodic.at(5, 2)), floor);
  EXPECT_EQ(colour(periodic.at(0, 0)), floor);
  frame.cell.walls = SideWalls{.arena = Arena::kSquare, .size = 40};  // out of sight
  EXPECT_EQ(colour(drawn(frame, kBlocks).at(9, 2)), floor);
}

TEST(RodCells, ThinRodsDoNotVanish) {
  RodFrame frame = frame_of({{5, 5, 0, 0}});
  frame.outlines = {{.half_length = 2, .middle = 1e-3, .end = 1e-3}};
  for (double theta = -1.5; theta < 1.6; theta += 0.1) {
    for (double y = 4.5; y < 5.5; y += 0.05) {
      frame.rods = {{5, y, theta, 0}};
      EXPECT_GE(n_dots(drawn(frame, kDots)), 5) << theta << " " << y;
    }
  }
}

TEST(RodCells, BlocksMixFromTwoByTwoSamples) {
  const CellGrid grid = drawn(frame_of({{5, 5.25, 0, 0}}), kBlocks);
  const Tone along = layer_tone(0);
  EXPECT_EQ(grid.at(4, 2), (ScreenCell{.glyph = U'▀', .fore = ink_of(along, 0.5), .back = ink_of(kFloorTone)}));
  EXPECT_EQ(grid.at(2, 2), (ScreenCell{.glyph = U'▀', .fore = ink_of(along, 0.25), .back = ink_of(kFloorTone)}));
  EXPECT_EQ(grid.at(0, 0), (ScreenCell{.back = ink_of(kFloorTone)}));
  // With few colours a half is a rod's or the floor's.
  RodStyle few = kBlocks;
  few.mixes = false;
  const CellGrid plain = drawn(frame_of({{5, 5.25, 0, 0}}), few);
  EXPECT_EQ(plain.at(4, 2).fore, ink_of(along));
  EXPECT_EQ(plain.at(2, 2), (ScreenCell{.back = ink_of(kFloorTone)}));
}

TEST(RodCells, OutsideTheBoxTheTerminalIsLeftAlone) {
  const CellGrid wide = drawn(frame_of({{0, 5.25, 0, 0}}), kBlocks, {}, 40, 5);
  for (int column = 0; column < 40; ++column) {
    EXPECT_EQ(wide.at(column, 0), (column >= 15 && column < 25 ? ScreenCell{.back = ink_of(kFloorTone)} : ScreenCell{}))
        << column;
  }
  EXPECT_EQ(wide.at(15, 2).glyph, U'▀');
}

TEST(RodCells, DefectsAreMarkedByTheirSign) {
  const std::vector<DefectMark> defects{{2.6, 9.9, true}, {9.9, 0.1, false}};
  const CellGrid grid = drawn(frame_of({}), kBlocks, {}, 10, 5, defects);
  EXPECT_EQ(grid.at(2, 0).glyph, U'+');
  EXPECT_EQ(grid.at(9, 4).glyph, U'−');
  RodStyle without = kBlocks;
  without.shows_defects = false;
  EXPECT_EQ(drawn(frame_of({}), without, {}, 10, 5, defects).at(2, 0).glyph, U' ');
}

TEST(RodColours, LeftAndRightOfTheDirectorDiffer) {
  RodFrame frame = frame_of({{2.5, 5.25, 0.4 + 0.3, 0}, {7.5, 5.25, 0.4 - 0.3, 0}});
  frame.director = 0.4;
  const CellGrid grid = drawn(frame, {.colouring = Colouring::kLayers, .grain = Grain::kBraille}, {}, 20, 10);
  EXPECT_EQ(grid.at(5, 4).fore, ink_of(layer_colour(0.3))) << "orange to the left";
  EXPECT_EQ(grid.at(15, 4).fore, ink_of(layer_colour(-0.3))) << "blue to the right";
  EXPECT_EQ(ink_of(layer_tone(0)), ink_of(layer_colour(0))) << "pale along it";
  // A rod has no head here, and directors are the same half a turn on.
  frame.rods[0].theta += kPi;
  frame.rods[1].theta -= kPi;
  EXPECT_EQ(drawn(frame, {.colouring = Colouring::kLayers, .grain = Grain::kBraille}, {}, 20, 10).at(5, 4).fore,
            ink_of(layer_tone(0.3)));
}

TEST(RodColours, TheWheelHasPeriodPi) {
  for (double angle = -3; angle < 3; angle += 0.1) EXPECT_EQ(wheel_tone(angle), wheel_tone(angle + kPi)) << angle;
  EXPECT_NE(wheel_tone(0), wheel_tone(kPi / 2));
  EXPECT_EQ(wheel_tone(kPi / 2), wheel_tone(-kPi / 2));
}

TEST(RodColours, AutomaticDoesNotFlicker) {
  Colouring colouring = Colouring::kWheel;
  for (const double order : {0.3, 0.65, 0.75}) {
    colouring = automatic_colouring(order, colouring);
    EXPECT_EQ(colouring, Colouring::kWheel) << order;
  }
  for (const double order : {0.85, 0.75, 0.65}) {
    colouring = automatic_colouring(order, colouring);
    EXPECT_EQ(colouring, Colouring::kLayers) << order;
  }
  EXPECT_EQ(automatic_colouring(0.55, colouring), Colouring::kWheel);
  EXPECT_EQ(automatic_colouring(std::nan(""), colouring), Colouring::kSpecies) << "spheres have no S";
}

TEST(RodColours, ThePageSaysWhenTheyChange) {
  const std::string page = *read_file(SHAKEN_SOURCE_DIR "/docs/watching.md");
  for (const std::string& words : {fmt::format("S is above {:.1f}", kOrderOfLayers + kOrderMargin),
                                   fmt::format("it is below {:.1f}", kOrderOfLayers - kOrderMargin)})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

TEST(RodColours, SpeciesHaveTheirOwn) {
  RodFrame frame = frame_of({{2.5, 5.25, 0, 0}, {7.5, 5.25, 0, 0}});
  frame.outlines.push_back(frame.outlines.front());
  frame.cell.shape_of_rod = {0, 1};
  const CellGrid grid = drawn(frame, {.colouring = Colouring::kWheel, .grain = Grain::kBraille});
  EXPECT_EQ(grid.at(2, 2).fore, ink_of(wheel_tone(0)));
  EXPECT_EQ(grid.at(7, 2).fore, ink_of(other_tone(1)));
}

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
