#include "render/rods_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "analysis/geometry/region.h"
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

// Floor within the walls, another tint beyond them, and a line of ink between.
TEST(RodsPass, WallsAreWhereTheyAreForRods) {
  for (const auto& [name, arena] : kArenaNames) {
    PictureStyle style;
    style.theme = static_cast<int>(arena) % 2 == 0 ? Theme::kLight : Theme::kDark;
    const PageColours colours = page_colours(style.theme);
    RodPicture picture = empty_picture(kBox);
    const double length = arena == Arena::kStadium ? 3 : 8;
    picture.cell.walls = SideWalls{.arena = arena, .size = 4, .inner = 2, .length = length, .narrow = 1};
    const analysis::Region region(kBox, picture.cell.walls);
    const Image image = draw(picture, style);
    int n_floor = 0, n_walls = 0;
    for (double y = 0.3; y < kBox - 0.3; y += 0.07) {
      for (double x = 0.3; x < kBox - 0.3; x += 0.07) {
        int n_within = 0;  // of eight places round about, beyond the line along an edge
        for (int k = 0; k < 8; ++k)
          n_within += region.contains(Vec2(x + 0.08 * std::cos(k * kPi / 4), y + 0.08 * std::sin(k * kPi / 4)));
        if (n_within != 0 && n_within != 8) continue;
        ++(n_within == 8 ? n_floor : n_walls);
        ASSERT_TRUE(is(colour_at(image, x, y), n_within == 8 ? colours.floor : colours.walls))
            << name << ' ' << x << ' ' << y;
      }
    }
    EXPECT_GT(std::min(n_floor, n_walls), 1000) << name;
    EXPECT_GT(count(image,
                    [&](const std::uint8_t* p) {
                      return is({p[0] / 255.0, p[1] / 255.0, p[2] / 255.0}, colours.ink);
                    }),
              500)
        << name;
  }
}

// One of 2 mm stands across the border.
TEST(RodsPass, PostsAreAsWhatLiesBeyondWalls) {
  const PageColours colours = page_colours(Theme::kLight);
  RodPicture picture = empty_picture(kBox);
  picture.cell.posts = {.diameter = 2, .centres = {Vec2(4, 5), Vec2(9.5, 8)}};
  const Image image = draw(picture, {});
  for (const Vec2& in : {Vec2(4, 5), Vec2(4.9, 5), Vec2(9, 8), Vec2(0.3, 8)})
    EXPECT_TRUE(is(colour_at(image, in.x(), in.y()), colours.walls)) << in.transpose();
  for (const Vec2& out : {Vec2(5.02, 5), Vec2(4.8, 5.8), Vec2(0.6, 8)})
    EXPECT_TRUE(is(colour_at(image, out.x(), out.y()), colours.floor)) << out.transpose();
  EXPECT_TRUE(is(colour_at(image, 4.995, 5), colours.ink)) << "a line along the rim";
  picture.cell.walls = SideWalls{Arena::kSquare, 10};
  EXPECT_TRUE(is(colour_at(draw(picture, {}), 0.3, 8), colours.floor)) << "walls leave it no image";
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
  many_beads.cell.shapes[0].offset.assign(RodsPass::kMostDrawnBeads + 1, 0);
  many_beads.cell.shapes[0].radius.assign(RodsPass::kMostDrawnBeads + 1, 1);
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
