#include "render/inset.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/headline.h"
#include "render/legend.h"
#include "render/make_movie.h"
#include "render/picture_layout.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

/// Rods on a lattice, in turn at `first` and at `second` [rad].
RodPicture two_angles(double first, double second) {
  RodPicture picture = empty_picture(40);
  for (int i = 0; i < 400; ++i) {
    add_rod(picture, 2.0 * (i % 20) + 1, 2.0 * (i / 20) + 1, i % 2 == 0 ? first : second);
  }
  measure(picture, {});
  return picture;
}

TEST(Inset, AnglesAreThoseToTheDirectorWhateverItIs) {
  for (const double director : {0.0, 1.2}) {
    const Curve curve = angle_curve(two_angles(director + 0.3, director - 0.3));  // 17.2 degrees
    const auto middle = curve.y.size() / 2;
    const auto left = std::max_element(curve.y.begin(), curve.y.begin() + static_cast<std::ptrdiff_t>(middle));
    const auto right = std::max_element(curve.y.begin() + static_cast<std::ptrdiff_t>(middle), curve.y.end());
    EXPECT_NEAR(curve.x[static_cast<std::size_t>(left - curve.y.begin())], -17.2, 2.6);
    EXPECT_NEAR(curve.x[static_cast<std::size_t>(right - curve.y.begin())], 17.2, 2.6);
    // All rods lie in two bins of 5 degrees: 1 / (2 * 5 degrees).
    EXPECT_NEAR(*left, 0.1, 2e-4);
    EXPECT_NEAR(*right, 0.1, 2e-4);
    EXPECT_EQ(curve.title, "P(\u03b8) (1/\u00b0)") << "as its axis has it";
    EXPECT_GE(curve.y_ticks.back().at, *left - 1e-9) << "the axis reaches above the curve";
    EXPECT_NEAR(curve.x.front(), -90, 1e-9);
    EXPECT_NEAR(curve.x.back(), 90, 1e-9);
  }
}

// Rods at +-0.3 rad in every fourth frame, at one angle in the others, which has twice as high a peak.
TEST(FilmAxes, StandStillWhereEachFrameAloneWouldHaveItsOwn) {
  PictureStyle style;
  style.inset = Inset::kAngles;
  const auto frame = [](std::size_t k) -> Result<RodPicture> {
    return k % 4 == 0 ? two_angles(0.3, -0.3) : two_angles(0, 0);
  };
  const auto axes = film_axes(40, frame, style);
  ASSERT_TRUE(static_cast<bool>(axes));
  RodPicture low = *frame(0), high = *frame(1);
  EXPECT_LT(highest_bar(low, style), highest_bar(high, style));
  EXPECT_LT(angle_curve(low).y_ticks.back().at, angle_curve(high).y_ticks.back().at);
  EXPECT_EQ(axes->share, highest_bar(high, style));
  low.captions.axes = high.captions.axes = *axes;
  EXPECT_EQ(angle_curve(low).y_ticks.back().at, angle_curve(high).y_ticks.back().at);
}

TEST(Inset, TheOrderOfTheRunEndsAtThePresent) {
  RodPicture picture = two_angles(0, 0);
  PictureStyle style;
  style.inset = Inset::kOrder;
  EXPECT_FALSE(has_inset(picture, style)) << "nothing is known of the time before";
  picture.frame.time = 3;
  picture.captions.history = {{0, 1, 3}, {0.1, 0.6, 1}, 0, 10};
  EXPECT_TRUE(has_inset(picture, style));
  const Curve curve = order_curve(picture);
  EXPECT_EQ(*curve.dot, Vec2(3, picture.found.order));
  EXPECT_EQ(curve.x_ticks.back().text, "10 s");
}

TEST(Inset, ASweepHasItsPointsAndARingRoundThisOne) {
  const SweepPlaces places = sweep_places(R"({"x": "rods.area_fraction", "y": "rods.length",
    "points": [[0.45, 2.5, 0.1], [0.8, 2.5, null], [0.8, 4.5, 0.9]], "here": [[0.8, 4.5]]})",
                                          1)
                                 .value();
  RodPicture picture = two_angles(0, 0);
  picture.captions.sweep = places.map;
  picture.captions.sweep_point = places.here[0];
  Curve curve = sweep_curve(picture.captions);
  EXPECT_EQ(curve.title, "\u2113 over \u03c6, by S");
  ASSERT_EQ(curve.dots.size(), 3U);
  EXPECT_EQ(*curve.ring, Vec2(0.8, 4.5));
  EXPECT_LT(curve.x_ticks.front().at, 0.45);
  EXPECT_GT(curve.x_ticks.back().at, 0.8);
  EXPECT_NE(curve.dots[0].colour, curve.dots[2].colour);

  // Of one parameter S is the height; a point without S has none.
  const SweepPlaces line =
      sweep_places(
          R"({"x": "plates.gamma", "y": "", "points": [[5, null, 0.2], [7, null, null]], "here": [[5, null]]})", 1)
          .value();
  picture.captions.sweep = line.map;
  picture.captions.sweep_point = line.here[0];
  curve = sweep_curve(picture.captions);
  ASSERT_EQ(curve.dots.size(), 1U);
  EXPECT_EQ(curve.dots[0].at, Vec2(5, 0.2));
  EXPECT_EQ(*curve.ring, Vec2(5, 0.2));

  for (const char* bad : {"", "[]", R"({"x": "a", "y": "b", "points": [[1]], "here": [[1, 2]]})",
                          R"({"x": "a", "y": "b", "points": [], "here": []})"}) {
    EXPECT_FALSE(sweep_places(bad, 1)) << bad;
  }
}

TEST(Inset, OnTheRodsChangesNothingElse) {
  const RodPicture picture = two_angles(0.2, -0.2);
  PictureStyle style;
  style.caption = style.legend = style.scale_bar = false;
  const Image without = painter().paint(picture, style).value();
  style.inset = Inset::kAngles;
  const Image with = painter().paint(picture, style).value();
  const Rect place = layout_of(style, {}).inset;
  int inside = 0;
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < with.width; ++x) {
      if (std::equal(with.pixel(x, y), with.pixel(x, y) + 3, without.pixel(x, y))) continue;
      const bool is_there = x >= place.x - 2 && x <= place.right() + 2 && y >= place.y - 2 && y <= place.bottom() + 2;
      ASSERT_TRUE(is_there) << x << ", " << y;
      ++inside;
    }
  }
  EXPECT_GT(inside, 0.9 * place.width * place.height);
}

}  // namespace
}  // namespace shaken::render
