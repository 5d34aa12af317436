#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "render/colours.h"
#include "render/rods_pass.h"
#include "tests/support/good.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace gap_view_test {

constexpr int kWidth = 900, kHeight = 450;
constexpr double kBox = 100;  // so wide that no image is seen

RodsPass& rods_pass() {
  static RodsPass shared = RodsPass::create().value();
  return shared;
}

PictureStyle gap_style() {
  PictureStyle style;
  style.view = ViewPoint::kGap;
  style.colour = "species";  // the first is orange, nothing else is
  style.mark_defects = false;
  return style;
}

Image look(const RodPicture& picture, const PictureStyle& style = gap_style()) {
  return rods_pass().draw(picture, style, kWidth, kHeight).value();
}

bool is_rod(const std::uint8_t* p) { return p[0] - p[2] > 25; }

/// First and last column, first and last row with a rod; all 0 if there is none.
struct Extent {
  int left = 0, right = 0, top = 0, bottom = 0;
  bool is_empty() const { return right == 0; }
};
Extent extent_of(const Image& image) {
  Extent extent{image.width, 0, image.height, 0};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!is_rod(image.pixel(x, y))) continue;
      extent.left = std::min(extent.left, x);
      extent.right = std::max(extent.right, x);
      extent.top = std::min(extent.top, y);
      extent.bottom = std::max(extent.bottom, y);
    }
  }
  return extent.right == 0 ? Extent{} : extent;
}

/// Where a point of the world [mm] is on the stage [pixels].
Vec2 pixel_of(const RodPicture& picture, const Vec3& point) {
  const Camera camera = camera_of(picture, gap_style(), double(kWidth) / kHeight);
  const Vec3 seen = camera.seen(point);
  return {kWidth * (0.5 + 0.5 * seen.x() / seen.z() / camera.half.x()),
          kHeight * (0.5 - 0.5 * seen.y() / seen.z() / camera.half.y())};
}

TEST(GapView, ARodIsWhereAndAsLargeAsItIs) {
  for (const double depth : {1.0, 6.0}) {  // behind the opening, which is in the middle of the box
    RodPicture picture = empty_picture(kBox);
    add_rod(picture, kBox / 2 + 1, kBox / 2 + depth, 0);
    const Extent extent = extent_of(look(picture));
    // A sphere's outline is a little wider than its equator's, by a factor 1 / cos of half the angle it fills.
    const Vec3& centre = picture.frame.position[0];
    EXPECT_NEAR(extent.left, pixel_of(picture, centre - Vec3(2.25, 0, 0)).x(), 4) << depth;
    EXPECT_NEAR(extent.right, pixel_of(picture, centre + Vec3(2.25, 0, 0)).x(), 4) << depth;
    EXPECT_NEAR(extent.top, pixel_of(picture, centre + Vec3(0, 0, 0.4)).y(), 3) << depth;
    EXPECT_NEAR(extent.bottom, pixel_of(picture, centre - Vec3(0, 0, 0.4)).y(), 3) << depth;
  }
}

TEST(GapView, ThePlatesAreDrawnWhereTheyAre) {
  RodPicture picture = empty_picture(kBox);
  struct Heights {
    double base;
    std::optional<double> lid;
  };
  for (const auto& [base, lid] : {Heights{0.0, {}}, {0.087, {}}, {0.05, 1.0}, {0.0, 1.4}}) {
    picture.frame.base = base;
    picture.frame.lid = lid;
    const Image image = look(picture);
    // From the middle of the gap down to the cut edge of the base, and up to that of the lid.
    const auto is_ink = [&](int y) { return image.pixel(kWidth / 4, y)[0] < 120; };
    int down = static_cast<int>(pixel_of(picture, Vec3(0, kBox / 2, base + 0.6)).y()), up = down;
    while (down < kHeight - 1 && !is_ink(down)) ++down;
    while (up > 0 && !is_ink(up)) --up;
    EXPECT_NEAR(down, pixel_of(picture, Vec3(0, kBox / 2, base)).y(), 2);
    EXPECT_NEAR(up, pixel_of(picture, Vec3(0, kBox / 2, lid.value_or(base + picture.cell.gap))).y(), 2);
  }
  picture.frame.has_lid = false;
  const Image open = look(picture);
  const Colour page = page_colours(Theme::kLight).page;
  EXPECT_NEAR(open.pixel(kWidth / 4, 5)[0], 255 * page[0], 1) << "nothing above";
}

TEST(GapView, RodsAreWhole) {
  // Nearer than the opening, across it, and behind it.
  for (const auto& [depth, is_seen] : {std::pair{-3.0, false}, {0.2, false}, {1.0, true}}) {
    RodPicture picture = empty_picture(kBox);
    add_rod(picture, kBox / 2, kBox / 2 + depth, 0);
    EXPECT_EQ(!extent_of(look(picture)).is_empty(), is_seen) << depth;
  }
}

TEST(GapView, APeriodicBoxGoesOnAndAnArenaDoesNot) {
  // Four rods in a row in depth, a box apart, each smaller than the one before.
  RodPicture picture = empty_picture(10);
  picture.cell.shapes = {{{0}, {0.3}}};
  add_rod(picture, 5, 6.5, 0);
  const auto coloured = [&] {
    const Image image = look(picture);
    int n = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) n += is_rod(image.pixel(x, y));
    }
    return n;
  };
  const int repeated = coloured();
  picture.cell.walls = SideWalls{Arena::kDisc, 10};
  const int alone = coloured();
  EXPECT_GT(alone, 500);
  EXPECT_GT(repeated, alone + 200);
}

TEST(GapView, EachLightGoesOutAlone) {
  RodPicture picture = empty_picture(kBox);
  add_rod(picture, kBox / 2, kBox / 2 + 2, 0.5);
  const Image all = look(picture);
  for (const auto light : {&Light::shadows, &Light::gloss, &Light::occlusion, &Light::smooth}) {
    PictureStyle style = gap_style();
    style.light.*light = false;
    EXPECT_NE(rods_pass().draw(picture, style, kWidth, kHeight).value(), all);
  }
  EXPECT_EQ(look(picture), all);
}

TEST(GapView, AnEmptyGapAndADegenerateOne) {
  EXPECT_TRUE(extent_of(look(empty_picture(kBox))).is_empty());
  RodPicture flat = empty_picture(kBox);
  flat.cell.gap = 0;
  EXPECT_THAT(test::refusal(rods_pass().draw(flat, gap_style(), kWidth, kHeight)), testing::HasSubstr("no gap"));
  PictureStyle style = gap_style();
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}, {720, 720}, {400, 900}}) {
    style.width = width;
    style.height = height;
    const Result<Image> image = test::good(painter().paint(empty_picture(kBox), style));
    EXPECT_EQ(image->height, height);
  }
}

}  // namespace gap_view_test
}  // namespace shaken::render
