#include "client/watch/screen_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "tests/support/small_terminal.h"

namespace shaken::client {
namespace {

using test::SmallTerminal;
using ::testing::HasSubstr;
using ::testing::Not;

/// Cells that look the same become equal: nothing of a blank is seen but what is behind it, and two colours of one half
/// block are those of the other, the other way round.
ScreenCell look(ScreenCell cell) {
  if (cell.glyph == U' ') return {.back = cell.back};
  if (cell.glyph == U'▄' && cell.fore >= 0 && cell.back >= 0 && !cell.bold && !cell.dim) {
    return {.glyph = U'▀', .fore = cell.back, .back = cell.fore};
  }
  return cell;
}

void expect_same(const SmallTerminal& terminal, const CellGrid& grid) {
  for (int line = 0; line < grid.lines(); ++line) {
    for (int column = 0; column < grid.columns(); ++column) {
      ASSERT_EQ(look(terminal.at(column, line)), look(grid.at(column, line))) << column << ", " << line;
    }
  }
}

TEST(ScreenWriter, ATerminalShowsWhatIsMeant) {
  std::mt19937 random(7);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  static constexpr std::array kInks{kOwnInk, theme_ink(2), theme_ink(6), 0x102030, 0xFF9000};
  static constexpr std::array kGlyphs{U' ', U'a', U'▀', U'⣿', U'▄'};
  SmallTerminal terminal(17, 6);
  ScreenWriter writer(ColourDepth::kTrue);
  CellGrid grid(17, 6);
  for (int round = 0; round < 300; ++round) {
    for (int n = below(40); n > 0; --n) {
      grid.at(below(17), below(6)) = {.glyph = kGlyphs[static_cast<std::size_t>(below(5))],
                                      .fore = kInks[static_cast<std::size_t>(below(5))],
                                      .back = kInks[static_cast<std::size_t>(below(5))],
                                      .bold = below(4) == 0,
                                      .dim = below(4) == 0};
    }
    terminal.write(writer.update(grid));
    expect_same(terminal, grid);
    ASSERT_EQ(terminal.misunderstood(), "");
    ASSERT_FALSE(terminal.is_updating());
  }
}

TEST(ScreenWriter, SendsOnlyWhatHasChanged) {
  ScreenWriter writer(ColourDepth::kTrue);
  CellGrid grid(200, 60);
  for (int line = 0; line < 60; ++line) grid.put(0, line, std::string(200, 'x'));
  EXPECT_GT(writer.update(grid).size(), 12000u);
  EXPECT_EQ(writer.update(grid), "");
  grid.at(7, 3).glyph = U'y';
  EXPECT_EQ(writer.update(grid), "\x1b[?2026h\x1b[4;8Hy\x1b[0m\x1b[?2026l");
  // Neighbours of one style need no more than their characters; a few columns on, a short step.
  grid.put(10, 3, "ab");
  grid.put(15, 3, "c");
  EXPECT_EQ(writer.update(grid), "\x1b[?2026h\x1b[4;11Hab\x1b[3Cc\x1b[0m\x1b[?2026l");
}

TEST(ScreenWriter, LooksAlikeForFewerBytes) {
  ScreenWriter writer(ColourDepth::kTrue);
  CellGrid grid(4, 1);
  writer.update(grid);
  grid.at(0, 0) = {.glyph = U'▀', .fore = 0x010101, .back = 0x020202};
  grid.at(1, 0) = {.glyph = U'▀', .fore = 0x020202, .back = 0x010101};
  grid.at(2, 0) = {.back = 0x020202};
  EXPECT_EQ(writer.update(grid), "\x1b[?2026h\x1b[1;1H\x1b[38;2;1;1;1;48;2;2;2;2m▀▄ \x1b[0m\x1b[?2026l");
}

TEST(ScreenWriter, AnotherSizeOrAForgottenScreenIsDrawnWhole) {
  ScreenWriter writer(ColourDepth::kTrue);
  CellGrid grid(10, 2);
  grid.put(0, 0, "hello");
  const std::string first = writer.update(grid);
  EXPECT_THAT(first, HasSubstr("\x1b[2J"));
  EXPECT_EQ(writer.update(grid), "");
  writer.forget();
  EXPECT_EQ(writer.update(grid), first);
  CellGrid larger(12, 3);
  larger.put(0, 0, "hello");
  EXPECT_THAT(writer.update(larger), HasSubstr("hello"));
}

TEST(ScreenWriter, UsesNoMoreColoursThanThereAre) {
  CellGrid grid(4, 1);
  grid.at(0, 0) = {.glyph = U'▀', .fore = 0xFF9000, .back = 0x2F8FFF};
  grid.at(1, 0) = {.glyph = U'x', .fore = theme_ink(2)};
  const auto bytes = [&](ColourDepth depth) { return ScreenWriter(depth).update(grid); };
  EXPECT_THAT(bytes(ColourDepth::kTrue), HasSubstr("\x1b[38;2;255;144;0;48;2;47;143;255m▀"));
  EXPECT_THAT(bytes(ColourDepth::k256), HasSubstr("\x1b[38;5;208;48;5;33m▀"));
  EXPECT_THAT(bytes(ColourDepth::k16), HasSubstr("\x1b[33;104m▀"));
  EXPECT_THAT(bytes(ColourDepth::k16), HasSubstr("\x1b[32;49mx"));
  EXPECT_THAT(bytes(ColourDepth::kNone), Not(HasSubstr("[3")));
  EXPECT_THAT(bytes(ColourDepth::kNone), Not(HasSubstr("[4")));
}

TEST(ColourDepth, FollowsTheEnvironment) {
  const auto depth = [](std::map<std::string, std::string> variables) {
    return colour_depth([&](const char* name) -> const char* {
      const auto place = variables.find(name);
      return place == variables.end() ? nullptr : place->second.c_str();
    });
  };
  EXPECT_EQ(depth({{"TERM", "xterm-256color"}, {"COLORTERM", "truecolor"}}), ColourDepth::kTrue);
  EXPECT_EQ(depth({{"TERM", "xterm-256color"}, {"COLORTERM", "truecolor"}, {"NO_COLOR", "1"}}), ColourDepth::kNone);
  EXPECT_EQ(depth({{"TERM", "tmux-256color"}, {"NO_COLOR", ""}}), ColourDepth::k256);
  EXPECT_EQ(depth({{"TERM", "xterm-direct"}}), ColourDepth::kTrue);
  EXPECT_EQ(depth({{"TERM", "linux"}}), ColourDepth::k16);
  EXPECT_EQ(depth({{"TERM", "vt100"}}), ColourDepth::kNone);
  EXPECT_EQ(depth({}), ColourDepth::kNone);
}

TEST(ColourDepth, NearestColours) {
  EXPECT_EQ(nearest_of_256(0x000000), 16);
  EXPECT_EQ(nearest_of_256(0xFFFFFF), 231);
  EXPECT_EQ(nearest_of_256(0xFF0000), 196);
  EXPECT_EQ(nearest_of_256(0x121212), 233);
  EXPECT_EQ(nearest_of_16(0x000000), 0);
  EXPECT_EQ(nearest_of_16(0xFE0101), 9);
  EXPECT_EQ(nearest_of_16(0x7A7F8A), 8) << "grey";
  EXPECT_EQ(nearest_of_16(0xECE8E4), 7);
  // The ends of the two sides, and six hues of the wheel: none becomes grey.
  EXPECT_EQ(nearest_of_16(0xFF9000), 3);
  EXPECT_EQ(nearest_of_16(0x2F8FFF), 12);
  for (const Ink ink : {0xF08B7C, 0xCBA640, 0x6EC17E, 0x0FC0D5, 0x8AA7FB, 0xD68DD2}) {
    const int hue = nearest_of_16(ink) % 8;
    EXPECT_TRUE(hue >= 1 && hue <= 6) << ink;
  }
}

}  // namespace
}  // namespace shaken::client
