// SPDX-License-Identifier: MIT
#include "render/rods_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "render/colours.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace rods_pass_test {

constexpr int kSide = 1000;
constexpr double kBox = 10, kScale = kSide / kBox;  // pixels per mm

RodsPass& rods_pass() {
  static RodsPass shared = RodsPass::create().value();
  return shared;
}

PictureStyle layers() {
  PictureStyle style;
  style.colour = "layers";
  style.palette = Palette::kPaper;  // red is told from the floor
  return style;
}

Image draw(const RodPicture& picture, const PictureStyle& style = layers(), int side = kSide) {
  return rods_pass().draw(picture, style, side, side).value();
}

/// Red or magenta, however dark: floor and shadow are grey.
bool is_rod(const std::uint8_t* pixel) { return pixel[0] - pixel[1] > 30; }

int count(const Image& image, const std::function<bool(const std::uint8_t*)>& test) {
  int n = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) n += test(image.pixel(x, y));
  }
  return n;
}

/// A box whose director lies so that a rod along x is fully red.
RodPicture red_picture() {
  RodPicture picture = empty_picture(kBox);
  picture.found.director_angle = -kPi / 6;
  return picture;
}

TEST(RodsPass, OutlineIsThatOfTheBeads) {
  RodPicture picture = red_picture();
  add_rod(picture, 5, 5, 0);
  const Image image = draw(picture);
  const auto width_at = [&](double mm_from_centre) {
    int n = 0;
    const int x = static_cast<int>(std::floor((5 + mm_from_centre) * kScale));
    for (int y = 0; y < kSide; ++y) n += is_rod(image.pixel(x, y));
    return n;
  };
  EXPECT_NEAR(width_at(0.005), 0.8 * kScale, 1.0);
  EXPECT_NEAR(width_at(2.055), 0.4 * kScale, 1.0);
  EXPECT_NEAR(width_at(-2.045), 0.4 * kScale, 1.0);
  // In between a tapered union of beads, neither a capsule nor a smooth spindle; the tips' vertical tangent aside.
  for (int pixel = -220; pixel < 220; ++pixel) {
    const double x = (pixel + 0.5) / kScale;
    EXPECT_NEAR(width_at(x), 2 * half_width(picture, x) * kScale, 1.6) << x;
  }
  int length = 0;
  for (int x = 0; x < kSide; ++x) length += is_rod(image.pixel(x, kSide / 2));
  EXPECT_NEAR(length, 4.5 * kScale, 1.0);
  EXPECT_NEAR(count(image, is_rod), picture.area_fraction() * kSide * kSide, 0.01 * 450 * 60);
}

TEST(RodsPass, EachLightGoesOutAlone) {
  RodPicture picture = red_picture();
  add_rod(picture, 5, 5, 0);
  const auto level = [](const Image& image, int x, int y) {
    const std::uint8_t* p = image.pixel(x, y);
    return p[0] + p[1] + p[2];
  };
  const Image all = draw(picture);
  PictureStyle style = layers();
  style.light.shadows = false;
  const Image no_shadows = draw(picture, style);
  const int floor = level(all, 100, 500);
  EXPECT_LT(level(all, 500, 545), floor - 20) << "under the rod's edge";
  EXPECT_EQ(level(no_shadows, 500, 545), floor);
  EXPECT_EQ(level(no_shadows, 500, 500), level(all, 500, 500)) << "the rod is as it was";

  style = layers();
  style.light.gloss = false;
  const Image no_gloss = draw(picture, style);
  style = layers();
  style.light.occlusion = false;
  const Image no_occlusion = draw(picture, style);
  EXPECT_GT(level(no_occlusion, 500, 537), level(all, 500, 537) + 20) << "its side is brighter";
  EXPECT_EQ(level(no_occlusion, 500, 500), level(all, 500, 500)) << "its back is as it was";
  int brightest = 0, brightest_without = 0;
  for (int y = 460; y < 540; ++y) {
    brightest = std::max(brightest, level(all, 500, y));
    brightest_without = std::max(brightest_without, level(no_gloss, 500, y));
  }
  EXPECT_GT(brightest, brightest_without + 20);

  style = layers();
  style.light.smooth = false;
  const Image beads = draw(picture, style);
  // From bead to bead along the rod.
  const auto ripple = [&](const Image& image) {
    int sum = 0;
    for (int x = 400; x < 600; ++x) sum += std::abs(level(image, x + 1, 500) - level(image, x, 500));
    return sum;
  };
  EXPECT_GT(ripple(beads), 2 * ripple(all));
  EXPECT_EQ(draw(picture), all) << "and all are lit again";
}

TEST(RodsPass, FewerSamplesShowTheSameWithHarderEdges) {
  RodPicture picture = red_picture();
  add_rod(picture, 5, 5, 0.3);
  std::vector<int> rods;
  for (const int samples : {1, 2, 3}) {
    PictureStyle style = layers();
    style.light.samples = samples;
    rods.push_back(count(draw(picture, style), is_rod));
  }
  EXPECT_NEAR(rods[0], rods[2], 0.01 * rods[2]);
  EXPECT_NEAR(rods[1], rods[2], 0.01 * rods[2]);
  // A pixel on the edge between rod and floor is one or the other with one sample, and between them with nine.
  picture.frame.director[0] = Vec3(1, 0, 0);
  PictureStyle hard = layers();
  hard.light.samples = 1;
  hard.light.shadows = false;
  EXPECT_NE(draw(picture, hard), draw(picture));
}

TEST(RodsPass, RodsAreDrawnWholeInWholePeriodicBoxesOnly) {
  RodPicture edge = red_picture();
  add_rod(edge, 0.1, 5, 0);
  PictureStyle style = layers(), plain = layers();
  style.whole = true;
  EXPECT_NE(draw(edge, style), draw(edge, plain));
  edge.cell.walls = SideWalls{Arena::kSquare, 10};
  EXPECT_EQ(draw(edge, style), draw(edge, plain));
  edge.cell.walls.reset();
  style.zoom = plain.zoom = 2;
  EXPECT_EQ(draw(edge, style), draw(edge, plain));
}

TEST(RodsPass, SamePictureSameBits) {
  RodPicture picture = empty_picture(kBox);
  for (int i = 0; i < 30; ++i) add_rod(picture, 0.37 * i, 0.61 * i, 0.2 * i, 0.01 * i);
  const Image first = draw(picture, layers(), 333);
  draw(red_picture(), layers(), 100);  // another size in between
  EXPECT_EQ(first, draw(picture, layers(), 333));
  RodsPass other = RodsPass::create().value();
  EXPECT_EQ(first, other.draw(picture, layers(), 333, 333).value());
  // Heights are all the same: the order of the rods decides nothing but ties.
}

/// Rods of a second kind alone in a box of 10 mm, the first of them in its middle.
RodPicture second_kind(const BeadRow& beads, double angle) {
  RodPicture picture = empty_picture(kBox);
  picture.cell.shapes.push_back(beads);
  picture.cell.shape_of_rod = {1};
  add_rod(picture, 5, 5, angle);
  return picture;
}

/// Where a teal rod, of the second kind, is seen.
std::vector<std::pair<int, int>> coloured(const Image& image) {
  std::vector<std::pair<int, int>> places;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      if (p[2] - p[0] > 12) places.emplace_back(x, y);  // bluer than any floor or shadow
    }
  }
  return places;
}

/// The colour of the pixel at a place of the box [mm].
Colour colour_at(const Image& image, double x, double y) {
  const std::uint8_t* p = image.pixel(static_cast<int>(x * kScale), static_cast<int>(kSide - y * kScale));
  return {p[0] / 255.0, p[1] / 255.0, p[2] / 255.0};
}

/// But for rounding.
bool is(const Colour& a, const Colour& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 0.02;
}

TEST(RodsPass, BeyondTheWallsTheFloorIsTinted) {
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    PictureStyle style;
    style.theme = theme;
    const PageColours colours = page_colours(theme);
    RodPicture picture = empty_picture(kBox);
    picture.cell.walls = SideWalls{Arena::kAnnulus, 8, 2};
    const Image annulus = draw(picture, style);
    picture.cell.walls->arena = Arena::kDisc;
    const Image disc = draw(picture, style);
    picture.cell.walls->arena = Arena::kSquare;
    const Image square = draw(picture, style);
    for (const Image& image : {annulus, disc, square}) {
      EXPECT_TRUE(is(colour_at(image, 5, 8.95), colours.floor));
      EXPECT_TRUE(is(colour_at(image, 5, 9.005), colours.ink)) << "a line along the edge";
      EXPECT_TRUE(is(colour_at(image, 5, 9.1), colours.walls));
      EXPECT_TRUE(is(colour_at(image, 0.5, 5), colours.walls));
    }
    EXPECT_TRUE(is(colour_at(disc, 8.8, 8.8), colours.walls));
    EXPECT_TRUE(is(colour_at(square, 8.8, 8.8), colours.floor));
    EXPECT_TRUE(is(colour_at(disc, 5, 5), colours.floor));
    EXPECT_TRUE(is(colour_at(annulus, 5, 5), colours.walls));
    EXPECT_TRUE(is(colour_at(annulus, 5, 6.05), colours.floor));
    // A view across the border shows no images: there is only one arena.
    style.zoom = 2;
    style.focus = Vec2(0, 0.5);
    picture.cell.walls->arena = Arena::kDisc;
    const Image border = draw(picture, style);
    EXPECT_TRUE(is(colour_at(border, 5, 5), colours.walls));
    EXPECT_TRUE(is(colour_at(border, 9, 5), colours.floor));
    EXPECT_TRUE(is(colour_at(border, 1, 5), colours.walls));
  }
}

// Posts of 2 mm, one of which stands across the border.
TEST(RodsPass, PostsAreAsWhatLiesBeyondWalls) {
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    PictureStyle style;
    style.theme = theme;
    const PageColours colours = page_colours(theme);
    RodPicture picture = empty_picture(kBox);
    picture.cell.posts = {.diameter = 2, .centres = {Vec2(4, 5), Vec2(9.5, 8)}};
    const Image image = draw(picture, style);
    EXPECT_TRUE(is(colour_at(image, 4, 5), colours.walls));
    EXPECT_TRUE(is(colour_at(image, 4.9, 5), colours.walls));
    EXPECT_TRUE(is(colour_at(image, 4.995, 5), colours.ink)) << "a line along the rim";
    EXPECT_TRUE(is(colour_at(image, 5.02, 5), colours.floor));
    EXPECT_TRUE(is(colour_at(image, 4.8, 5.8), colours.floor));
    EXPECT_TRUE(is(colour_at(image, 9, 8), colours.walls));
    EXPECT_TRUE(is(colour_at(image, 0.3, 8), colours.walls)) << "its image";
    EXPECT_TRUE(is(colour_at(image, 0.6, 8), colours.floor));
    picture.cell.walls = SideWalls{Arena::kSquare, 10};
    EXPECT_TRUE(is(colour_at(draw(picture, style), 0.3, 8), colours.floor)) << "walls leave it no image";
  }
}

// A rod within a post, where no simulation brings it, is not seen: neither from aside nor where the post is cut open.
TEST(RodsPass, APostHidesWhatIsBehindItsSurface) {
  for (const ViewPoint view : {ViewPoint::kGap, ViewPoint::kOrbit}) {
    PictureStyle style = layers();
    style.view = view;
    RodPicture picture = red_picture();
    add_rod(picture, 5, 6.2, 0);
    EXPECT_GT(count(draw(picture, style), is_rod), 100);
    picture.cell.posts = {.diameter = 6, .centres = {Vec2(5, 5)}};
    EXPECT_EQ(count(draw(picture, style), is_rod), 0);
    picture.cell.posts = {.diameter = 1, .centres = {Vec2(1, 9)}};
    EXPECT_GT(count(draw(picture, style), is_rod), 100);
  }
}

// Of radius 2 about (3.5, 5) and (6.5, 5); and between 3 and 7 mm upwards.
TEST(RodsPass, AStadiumAndAChannelEndAtTheirWalls) {
  const PageColours colours = page_colours(Theme::kLight);
  RodPicture picture = empty_picture(kBox);
  picture.cell.walls = SideWalls{.arena = Arena::kStadium, .size = 4, .length = 3};
  const Image stadium = draw(picture);
  picture.cell.walls->arena = Arena::kChannel;
  const Image channel = draw(picture);
  for (const Image& image : {stadium, channel}) {
    for (const double x : {3.5, 5.0, 6.5}) {
      EXPECT_TRUE(is(colour_at(image, x, 6.95), colours.floor));
      EXPECT_TRUE(is(colour_at(image, x, 7.005), colours.ink));
      EXPECT_TRUE(is(colour_at(image, x, 7.1), colours.walls));
      EXPECT_TRUE(is(colour_at(image, x, 2.9), colours.walls));
    }
  }
  EXPECT_TRUE(is(colour_at(stadium, 8.4, 5), colours.floor));
  EXPECT_TRUE(is(colour_at(stadium, 8.6, 5), colours.walls));
  EXPECT_TRUE(is(colour_at(stadium, 1.9, 6.6), colours.walls)) << "2.26 mm from the centre of its end";
  EXPECT_TRUE(is(colour_at(channel, 0.02, 5), colours.floor));
  EXPECT_TRUE(is(colour_at(channel, 9.98, 6.6), colours.floor));
}

// Half axes of 4 and 2 mm; and 4 mm wide on the left, 1 mm on the right, 8 mm from each other.
TEST(RodsPass, AnEllipseAndAWedgeEndAtTheirWalls) {
  const PageColours colours = page_colours(Theme::kLight);
  RodPicture picture = empty_picture(kBox);
  picture.cell.walls = SideWalls{.arena = Arena::kEllipse, .size = 4, .length = 8, .narrow = 1};
  const Image ellipse = draw(picture);
  picture.cell.walls->arena = Arena::kWedge;
  const Image wedge = draw(picture);
  const auto ends_at = [&](const Image& image, const Vec2& edge, const Vec2& outwards) {
    const auto colour = [&](double off) {
      const Vec2 place = edge + off * outwards.normalized();
      return colour_at(image, place.x(), place.y());
    };
    EXPECT_TRUE(is(colour(-0.05), colours.floor)) << edge.transpose();
    EXPECT_TRUE(is(colour(0.0104), colours.ink)) << edge.transpose();  // half of the line's thickness
    EXPECT_TRUE(is(colour(0.1), colours.walls)) << edge.transpose();
  };
  for (const double angle : {0.0, 0.2, 0.9, 1.57, 3.14, 4.0, 5.5}) {
    const Vec2 from_middle(4 * std::cos(angle), 2 * std::sin(angle));
    ends_at(ellipse, Vec2(5, 5) + from_middle, {from_middle.x() / 16, from_middle.y() / 4});
  }
  EXPECT_TRUE(is(colour_at(ellipse, 5, 5), colours.floor));
  ends_at(wedge, {1, 5}, {-1, 0});
  ends_at(wedge, {1, 6.5}, {-1, 0});
  ends_at(wedge, {9, 5}, {1, 0});
  for (const double way : {1.0, -1.0}) {
    ends_at(wedge, {3, 5 + way * 1.625}, {0.1875, way});
    ends_at(wedge, {8, 5 + way * 0.6875}, {0.1875, way});
  }
}

TEST(RodsPass, AChannelGoesOnAlongItself) {
  RodPicture picture = second_kind({{0}, {0.5}}, 0);
  picture.cell.walls = SideWalls{.arena = Arena::kChannel, .size = 8};
  PictureStyle style = layers();
  style.zoom = 2;
  style.focus = Vec2(0.1, 0.5);  // from -1.5 to 3.5 mm
  picture.frame.position[0] = Vec3(9.4, 5, 0.6);
  EXPECT_FALSE(coloured(draw(picture, style)).empty());
  style.focus = Vec2(0.5, 0.1);
  picture.frame.position[0] = Vec3(5, 8.4, 0.6);
  EXPECT_TRUE(coloured(draw(picture, style)).empty()) << "but not across";
}

TEST(RodsPass, NothingWrapsRoundAnArena) {
  RodPicture picture = second_kind({{0}, {0.5}}, 0);
  picture.cell.walls = SideWalls{Arena::kDisc, 8};
  picture.frame.position[0] = Vec3(5, 8.4, 0.6);  // at the upper wall
  PictureStyle style = layers();
  style.zoom = 2;
  style.focus = Vec2(0.5, 0.1);  // from -1.5 to 3.5 mm upwards
  EXPECT_TRUE(coloured(draw(picture, style)).empty());
  picture.cell.walls.reset();
  EXPECT_FALSE(coloured(draw(picture, style)).empty()) << "where there are no walls it does";
}

TEST(RodsPass, RefusesWhatCannotBeDrawn) {
  const auto message = [](const RodPicture& picture, int side = 64) {
    const Result<Image> image = rods_pass().draw(picture, layers(), side, side);
    return image ? std::string("drawn") : image.error().message;
  };
  RodPicture no_beads = red_picture();
  no_beads.cell.shapes[0].offset.clear();
  no_beads.cell.shapes[0].radius.clear();
  EXPECT_NE(message(no_beads).find("0 beads"), std::string::npos);
  RodPicture many_beads = red_picture();
  many_beads.cell.shapes[0].offset.assign(RodsPass::kMaxBeads + 1, 0);
  many_beads.cell.shapes[0].radius.assign(RodsPass::kMaxBeads + 1, 1);
  EXPECT_NE(message(many_beads).find("256 beads"), std::string::npos);
  RodPicture uneven = red_picture();
  uneven.frame.position.emplace_back(1, 1, 1);
  EXPECT_NE(message(uneven).find("directors"), std::string::npos);
  RodPicture unknown_kind = second_kind({{0}, {0.5}}, 0);
  unknown_kind.cell.shape_of_rod[0] = 2;
  EXPECT_NE(message(unknown_kind).find("of a shape whose beads"), std::string::npos);
  unknown_kind.cell.shape_of_rod.clear();
  EXPECT_NE(message(unknown_kind).find("each rod's shape"), std::string::npos);
  EXPECT_NE(message(empty_picture(0)).find("no size"), std::string::npos);
  EXPECT_NE(message(red_picture(), 0).find("pixels; possible are"), std::string::npos);
  EXPECT_NE(message(red_picture(), RodsPass::kMaxSide + 1).find("pixels; possible are"), std::string::npos);
  EXPECT_EQ(message(red_picture()), "drawn");
}

}  // namespace rods_pass_test
}  // namespace shaken::render
