// SPDX-License-Identifier: MIT
#include "client/watch/rod_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace shaken::client {
namespace {

/// A box of 10 mm with rods of 4.5 mm and radius 0.25 mm.
RodFrame frame_of(std::vector<proto::RodPose> rods) {
  RodFrame frame;
  frame.cell.box = 10;
  frame.outlines = {{.half_length = 2, .middle = 0.25, .end = 0.25}};
  frame.rods = std::move(rods);
  return frame;
}

Ink ink_at(const RodImage& image, int x, int y) {
  const auto colour = 3U * image.pixels[static_cast<std::size_t>(y * image.size.width + x)];
  const auto palette = rod_palette();
  return palette[colour] << 16 | palette[colour + 1] << 8 | palette[colour + 2];
}

std::ptrdiff_t n_pixels(const RodImage& image, Tone tone) {
  return std::count(image.pixels.begin(), image.pixels.end(), tone);
}

TEST(RodImage, ARodHasItsAreaAtEverySize) {
  const double area = 4 * 0.5 + 3.14159265 * 0.25 * 0.25;  // a stadium [mm^2]
  for (const int side : {60, 300, 900}) {
    for (const double theta : {0.0, 0.5, 1.5}) {
      const RodImage image = draw_rod_image(frame_of({{5, 5, theta, 0}}), {}, {}, Colouring::kWheel, {side, side}, 20);
      const double expected = area * side * side / 100.0;
      EXPECT_NEAR(static_cast<double>(n_pixels(image, wheel_tone(theta))), expected, 9.0 * side / 10 * 0.5)
          << side << " " << theta;
    }
  }
}

TEST(RodImage, PixelsAreWhatTheyAreInTheBox) {
  const RodImage image = draw_rod_image(frame_of({{5, 7, 0, 0}}), {}, {}, Colouring::kLayers, {200, 120}, 20);
  ASSERT_EQ(image.pixels.size(), 200U * 120U);
  EXPECT_EQ(ink_at(image, 100, 36), ink_of(layer_tone(0))) << "y goes up: 7 mm are 36 pixels from the top";
  EXPECT_EQ(ink_at(image, 100, 84), ink_of(kFloorTone));
  EXPECT_EQ(ink_at(image, 100, 42), ink_of(kFloorTone)) << "a rod's radius is 3 pixels";
  // The box is as high as the image, in the middle of it.
  EXPECT_EQ(ink_at(image, 39, 60), 0x000000);
  EXPECT_EQ(ink_at(image, 40, 60), ink_of(kFloorTone));
  EXPECT_EQ(ink_at(image, 159, 60), ink_of(kFloorTone));
  EXPECT_EQ(ink_at(image, 160, 60), 0x000000);
}

TEST(RodImage, DefectsAreDiscsWithTheirSign) {
  const std::vector<DefectMark> defects{{2, 8, true}, {0.01, 9.99, false}};
  const RodImage image = draw_rod_image(frame_of({}), defects, {}, Colouring::kLayers, {300, 300}, 20);
  EXPECT_EQ(ink_at(image, 60, 60), 0x000000);
  EXPECT_EQ(ink_at(image, 60, 55), 0x000000) << "the stroke down of a plus";
  EXPECT_EQ(ink_at(image, 65, 55), 0xFFFFFF);
  EXPECT_EQ(ink_at(image, 60, 72), ink_of(kFloorTone));
  // At the box's edge a part of it is seen, on one side.
  EXPECT_EQ(ink_at(image, 0, 299), ink_of(kFloorTone));
  EXPECT_EQ(ink_at(image, 0, 0), 0xFFFFFF);
  EXPECT_EQ(ink_at(image, 0, 5), 0x000000) << "a minus has no stroke down";
}

TEST(RodImage, ItsLinesAreWholeSixels) {
  EXPECT_EQ(image_size({10, 20}, {0, 1, 74, 37}), (PixelSize{740, 738}));
  EXPECT_EQ(image_size({7, 13}, {3, 1, 24, 12}), (PixelSize{168, 156}));
}

}  // namespace
}  // namespace shaken::client
