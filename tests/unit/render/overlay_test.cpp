// SPDX-License-Identifier: MIT
#include "render/overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/colours.h"
#include "render/layout.h"
#include "render/rods_pass.h"
#include "tests/unit/render/support.h"

namespace shaken::render {
namespace {

constexpr int kSide = 720;  // of a bare picture: one unit is one pixel
constexpr double kBox = 20;

PictureStyle bare() {
  PictureStyle style;
  style.width = style.height = kSide;
  style.caption = style.legend = style.scale_bar = false;
  return style;
}

/// Brightness at `distance` pixels from a point of the box in direction `angle`.
int grey_at(const Image& image, const Vec2& place, double distance, double angle) {
  const double x = place.x() / kBox * kSide + distance * std::cos(angle);
  const double y = kSide - place.y() / kBox * kSide - distance * std::sin(angle);
  const std::uint8_t* pixel = image.pixel(static_cast<int>(x), static_cast<int>(y));
  return (pixel[0] + pixel[1] + pixel[2]) / 3;
}

// The floor is brighter than kDark and darker than white.
constexpr int kDark = 60, kWhite = 252;

TEST(Overlay, APlusHalfIsADiscWithAnArrowAlongItsDirection) {
  for (const double direction : {0.0, 2.0, -1.2}) {
    RodPicture picture = empty_picture(kBox);
    const Vec2 place(6, 15);
    picture.defects = {{place, 0.5, direction}};
    const Image image = painter().paint(picture, bare()).value();
    EXPECT_LT(grey_at(image, place, 0, 0), kDark);
    EXPECT_LT(grey_at(image, place, 5, direction + kPi), kDark);
    EXPECT_LT(grey_at(image, place, 15, direction), kDark);
    EXPECT_LT(grey_at(image, place, 25, direction), kDark);
    EXPECT_GT(grey_at(image, place, 15, direction + kPi), kDark);
    EXPECT_GT(grey_at(image, place, 15, direction + kPi / 2), kDark);
    EXPECT_GT(grey_at(image, place, 35, direction), kDark);
  }
}

TEST(Overlay, AMinusHalfHasThreeArms) {
  for (const double direction : {0.0, 0.9}) {
    RodPicture picture = empty_picture(kBox);
    const Vec2 place(12, 4);
    picture.defects = {{place, -0.5, direction}};
    const Image image = painter().paint(picture, bare()).value();
    EXPECT_GE(grey_at(image, place, 0, 0), kWhite);
    for (int arm = 0; arm < 3; ++arm) {
      const double along = direction + arm * 2 * kPi / 3;
      EXPECT_GE(grey_at(image, place, 12, along), kWhite) << arm;
      EXPECT_LT(grey_at(image, place, 12, along + kPi / 3), kWhite) << arm;
      EXPECT_LT(grey_at(image, place, 6.1, along + kPi / 3), 120) << arm;  // the rim in the waist
    }
  }
}

TEST(Overlay, AMarkAcrossTheBorderShowsOnBothSides) {
  RodPicture picture = empty_picture(kBox);
  picture.defects = {{Vec2(0.02, 10), 0.5, kPi}};
  const Image image = painter().paint(picture, bare()).value();
  EXPECT_LT(grey_at(image, Vec2(0.02, 10), 3, 0), kDark);
  EXPECT_LT(grey_at(image, Vec2(kBox, 10), 15, kPi), kDark);
}

TEST(Overlay, UnmarkedDefectsAreNotDrawn) {
  RodPicture with = empty_picture(kBox);
  with.defects = {{Vec2(6, 15), 0.5, 0}};
  PictureStyle style = bare();
  style.mark_defects = false;
  EXPECT_EQ(painter().paint(with, style).value(), painter().paint(empty_picture(kBox), style).value());
}

TEST(Overlay, NoTextOnTheRods) {
  RodPicture picture = empty_picture(kBox);
  for (int i = 0; i < 20; ++i) add_rod(picture, i, i, 0.3 * i);
  measure(picture, false);
  picture.time = 1234.56;
  picture.label = "rods.length=4.5 rods.area_fraction=0.80 plates.gamma=7 replica=3";
  picture.history = {{0, 1000, 1234.56}, {0.2, 0.8, picture.order}, 0, 6000};
  RodsPass rods = RodsPass::create().value();
  for (const auto& [width, height] : {std::pair{1280, 720}, {1000, 1000}, {640, 360}, {800, 1200}, {1024, 768}}) {
    for (const Colouring colouring : {Colouring::kLayers, Colouring::kWheel}) {
      PictureStyle style;
      style.width = width;
      style.height = height;
      style.colouring = colouring;
      const Image image = painter().paint(picture, style).value();
      const Layout layout = layout_of(style, true, true);
      const Image alone = rods.draw(picture, style, layout.box_side).value();
      for (int y = 0; y < layout.box_side; ++y) {
        ASSERT_TRUE(std::equal(alone.pixel(0, y), alone.pixel(0, y) + alone.row_bytes(),
                               image.pixel(layout.box_x, layout.box_y + y)))
            << "row " << y << " of " << width << 'x' << height;
      }
      // Nor does anything run out of the picture: its border is page.
      for (int y = 0; y < height; ++y) {
        ASSERT_EQ(image.pixel(width - 1, y)[0], 255) << "row " << y << " of " << width << 'x' << height;
        ASSERT_EQ(image.pixel(0, y)[0], 255) << "row " << y << " of " << width << 'x' << height;
      }
    }
  }
}

TEST(Overlay, TheScaleBarIsToScale) {
  for (const double zoom : {1.0, 3.0}) {
    PictureStyle style;
    style.zoom = zoom;
    const RodPicture picture = empty_picture(83.73);
    const Image image = painter().paint(picture, style).value();
    const Layout layout = layout_of(style, false, false);
    const int y = static_cast<int>(layout.scale_bar.bottom() - 2.5 * layout.unit);
    int dark = 0;
    for (int x = layout.box_x + layout.box_side + 5; x < image.width; ++x) dark += image.pixel(x, y)[0] < 128;
    const double mm = dark * 83.73 / zoom / layout.box_side;
    EXPECT_NEAR(mm, zoom == 1 ? 20 : 10, 2 * 83.73 / zoom / layout.box_side);
  }
}

TEST(Overlay, TheLegendShowsHowManyRodsLeanEachWay) {
  // Two thirds of the rods at +10 degrees, one third at -20: the peaks' heights in the histogram are 2 to 1.
  RodPicture picture = empty_picture(kBox);
  const double degree = kPi / 180;
  for (int i = 0; i < 30; ++i) add_rod(picture, 0.6 * i, 0.6 * i, (i % 3 ? 10.2 : -20.2) * degree);
  PictureStyle style;
  const Image image = painter().paint(picture, style).value();
  const Layout layout = layout_of(style, false, false);
  const auto height_at = [&](double degrees) {
    const int x = static_cast<int>(layout.legend.x + (degrees + 45) / 90 * layout.legend.width);
    int coloured = 0;
    // Down to the colour bar, which is there at every angle.
    for (int y = static_cast<int>(layout.legend.y + 22); y < layout.legend.bottom() - 34; ++y) {
      coloured += image.pixel(x, y)[0] - image.pixel(x, y)[1] > 30;
    }
    return coloured;
  };
  EXPECT_GT(height_at(10.2), 50);
  EXPECT_NEAR(height_at(-20.2) / double(height_at(10.2)), 0.5, 0.03);
  EXPECT_EQ(height_at(30), 0);
}

TEST(Overlay, EveryStyleCanBeDrawnWithoutRods) {
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    for (const Colouring colouring : {Colouring::kLayers, Colouring::kWheel}) {
      PictureStyle style;
      style.theme = theme;
      style.colouring = colouring;
      const Result<Image> image = painter().paint(empty_picture(kBox), style);
      ASSERT_TRUE(image);
      EXPECT_EQ(image->width, 1280);
      EXPECT_EQ(image->height, 720);
      EXPECT_EQ(image->pixel(0, 0)[0] < 128, theme == Theme::kDark);
    }
  }
}

TEST(RoundLength, IsTheLongestOneTwoFive) {
  EXPECT_DOUBLE_EQ(round_length(1), 1);
  EXPECT_DOUBLE_EQ(round_length(1.99), 1);
  EXPECT_DOUBLE_EQ(round_length(2), 2);
  EXPECT_DOUBLE_EQ(round_length(4.9), 2);
  EXPECT_DOUBLE_EQ(round_length(7), 5);
  EXPECT_DOUBLE_EQ(round_length(37), 20);
  EXPECT_DOUBLE_EQ(round_length(0.3), 0.2);
}

TEST(Overlay, SeveralKindsOfRodsAreShownBesideTheLegend) {
  RodPicture picture = empty_picture(kBox);
  picture.added = {{{0}, {0.8}}};
  for (int i = 0; i < 5; ++i) {
    add_rod(picture, 3 * i + 1, 10, 0.2);
    picture.species_of_rod.push_back(i < 3 ? 0 : 1);
  }
  const PictureStyle style;
  const Layout layout = layout_of(style, false, false, true);
  const Image image = painter().paint(picture, style).value();
  // The second of the two columns begins with a teal disc, the first with a pale rod.
  const int y = static_cast<int>(layout.species.y + layout.species.height / 2);
  const auto at = [&](double x) { return image.pixel(static_cast<int>(x), y); };
  const std::uint8_t* disc = at(layout.species.x + layout.species.width / 2 + 6);
  const std::uint8_t* rod = at(layout.species.x + 12);
  const Colour teal = species_colour(1), pale = layer_colour(0);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(disc[c], 255 * teal[c], 2) << c;
    EXPECT_NEAR(rod[c], 255 * pale[c], 2) << c;
  }
  // One species alone needs no such thing.
  picture.added.clear();
  picture.species_of_rod.clear();
  EXPECT_EQ(layout_of(style, false, false).species.width, 0);
  const Image plain = painter().paint(picture, style).value();
  EXPECT_EQ(plain.pixel(static_cast<int>(layout.species.x + layout.species.width / 2 + 6), y)[0], 255);
}

}  // namespace
}  // namespace shaken::render
