// SPDX-License-Identifier: MIT
#include "client/watch/image_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "client/watch/kitty.h"
#include "client/watch/sixel.h"
#include "tests/support/small_terminal.h"

namespace shaken::client {
namespace {

using test::SmallTerminal;
using ::testing::HasSubstr;

constexpr Area kArea{3, 1, 40, 20};
constexpr SmallTerminal::Skills kBoth{.knows_kitty = true, .knows_sixel = true, .cell_width = 5, .cell_height = 9};

/// Rods at random, or every pixel at random.
RodImage rods_at_random(unsigned seed, PixelSize size) {
  std::mt19937 random(seed);
  const auto uniform = [&random](double high) { return high * static_cast<double>(random() % 4096) / 4096; };
  RodFrame frame;
  frame.cell.box = 10;
  frame.outlines = {{.half_length = 1, .middle = 0.3, .end = 0.1}};
  for (int i = 0; i < 60; ++i) frame.rods.push_back({uniform(10), uniform(10), uniform(3), 0});
  return draw_rod_image(frame, {{3, 3, true}, {7, 7, false}}, {}, Colouring::kWheel, size, 12);
}
RodImage noise(unsigned seed, PixelSize size) {
  std::mt19937 random(seed);
  RodImage image{.size = size, .pixels = {}};
  for (int i = 0; i < size.width * size.height; ++i) {
    image.pixels.push_back(static_cast<std::uint8_t>(random() % kPaletteSize));
  }
  return image;
}

/// `tolerance` of each part of a colour: sixels have them in hundredths.
void expect_same(const test::TerminalImage& shown, const RodImage& image, int tolerance) {
  ASSERT_EQ(shown.width, image.size.width);
  ASSERT_EQ(shown.height, image.size.height);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const int ink = shown.at(x, y);
      ASSERT_GE(ink, 0) << x << " " << y << " is not painted";
      const auto colour = 3U * image.pixels[static_cast<std::size_t>(y * image.size.width + x)];
      for (const int part : {0, 1, 2}) {
        ASSERT_LE(std::abs((ink >> (16 - 8 * part) & 0xFF) - rod_palette()[colour + static_cast<unsigned>(part)]),
                  tolerance)
            << x << " " << y;
      }
    }
  }
}

TEST(ImageWriter, EveryPixelComesThrough) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const PixelSize size{.width = 1 + static_cast<int>(37 * seed), .height = 6 * (1 + static_cast<int>(seed) * 3)};
    for (const RodImage& image : {rods_at_random(seed, size), noise(seed, size)}) {
      for (const Graphics graphics : {Graphics::kSixel, Graphics::kKitty}) {
        SmallTerminal terminal(200, 60, kBoth);
        terminal.write(ImageWriter().update(image, kArea, graphics));
        ASSERT_TRUE(terminal.image());
        EXPECT_EQ(terminal.misunderstood(), "");
        EXPECT_EQ(terminal.image()->column, kArea.column);
        EXPECT_EQ(terminal.image()->line, kArea.line);
        EXPECT_EQ(terminal.image()->is_sixel, graphics == Graphics::kSixel);
        expect_same(terminal.image()->image, image, graphics == Graphics::kSixel ? 1 : 0);
      }
    }
  }
}

TEST(ImageWriter, SendsOnlyWhatHasChanged) {
  for (const Graphics graphics : {Graphics::kSixel, Graphics::kKitty}) {
    const RodImage first = rods_at_random(1, {60, 60}), second = rods_at_random(2, {60, 60});
    ImageWriter writer;
    EXPECT_FALSE(writer.is_shown());
    const std::string bytes = writer.update(first, kArea, graphics);
    EXPECT_TRUE(writer.is_shown());
    EXPECT_EQ(writer.update(first, kArea, graphics), "");
    EXPECT_NE(writer.update(second, kArea, graphics), "");
    EXPECT_EQ(writer.update(first, kArea, graphics), bytes);
    writer.forget();
    EXPECT_EQ(writer.update(first, kArea, graphics), bytes);
    EXPECT_EQ(writer.update(first, kArea, graphics), "");
    Area moved = kArea;
    ++moved.column;
    EXPECT_NE(writer.update(first, moved, graphics), "");
  }
}

TEST(ImageWriter, TakesKittysImageAwayOnce) {
  SmallTerminal terminal(200, 60, kBoth);
  ImageWriter writer;
  EXPECT_EQ(writer.remove(), "");
  terminal.write(writer.update(rods_at_random(1, {300, 300}), kArea, Graphics::kKitty));
  ASSERT_TRUE(terminal.image());
  terminal.write(writer.remove());
  EXPECT_FALSE(terminal.image());
  EXPECT_EQ(writer.remove(), "");
  EXPECT_FALSE(writer.is_shown());
}

TEST(Kitty, CommandsAskForNoAnswerButTheQuestion) {
  EXPECT_THAT(kitty_text(noise(1, {30, 30})), HasSubstr("q=2"));
  EXPECT_THAT(kitty_removal(), HasSubstr("q=2"));
  SmallTerminal kitty(80, 24, {.knows_kitty = true}), other(80, 24);
  for (SmallTerminal* terminal : {&kitty, &other}) terminal->write(terminal_questions());
  EXPECT_THAT(kitty.take_answers(), HasSubstr(";OK\x1b\\"));
  EXPECT_EQ(other.take_answers(), "\x1b[?62;22c");
}

}  // namespace
}  // namespace shaken::client
