#include "render/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/canvas.h"
#include "render/colourings.h"
#include "render/colours.h"
#include "render/marks.h"
#include "render/picture_layout.h"
#include "render/rods_pass.h"
#include "render/view.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace overlay_test {

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

/// Relative luminance (WCAG 2.1, IEC 61966-2-1).
double luminance(const Colour& colour) {
  const auto linear = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

double contrast(const Colour& a, const Colour& b) {
  const auto [low, high] = std::minmax({luminance(a), luminance(b)});
  return (high + 0.05) / (low + 0.05);
}

// Whoever comes from the page meets a colour that stands out, before all others; and the next stands out from that.
TEST(Marks, OutlinesHoldContrastOnEveryPage) {
  for (const Theme theme : {Theme::kLight, Theme::kDark, Theme::kPrint}) {
    for (const Colour& page : {page_colours(theme).page, page_colours(theme).floor}) {
      for (const bool is_plus : {true, false}) {
        Canvas canvas(400, 400, page);
        (is_plus ? draw_plus_half : draw_minus_half)(canvas, 200, 200, 0, 6);
        const Image image = canvas.image();
        // To the left of the middle are the head of the comet and the gap between two arms.
        std::vector<Colour> met;
        int since = 0;
        for (int x = 0; x <= 200; ++x) {
          const std::uint8_t *now = image.pixel(x, 200), *before = image.pixel(std::max(x - 1, 0), 200);
          since = std::equal(now, now + 3, before) ? since + 1 : 0;
          const Colour colour{now[0] / 255.0, now[1] / 255.0, now[2] / 255.0};
          if (since == 2 && (met.empty() || met.back() != colour)) met.push_back(colour);
        }
        ASSERT_GE(met.size(), 4u) << "page, rim, rim, body";
        for (std::size_t k = 1; k < 4; ++k) EXPECT_GE(contrast(met[k - 1], met[k]), 3) << k << ' ' << is_plus;
      }
    }
  }
}

TEST(Typeset, MinusAndMicroAreThoseOfPrint) {
  EXPECT_EQ(typeset("-3 mm, x = -0.5, 1e-3"), "\u22123 mm, x = \u22120.5, 1e-3");
  EXPECT_EQ(typeset("dt = 4 us, 2 um"), "dt = 4 \u00b5s, 2 \u00b5m");
  EXPECT_EQ(typeset("run-2 of 3 users"), "run-2 of 3 users");
}

TEST(Overlay, AMarkAcrossTheBorderShowsOnBothSides) {
  RodPicture picture = empty_picture(kBox);
  picture.found.defects = {{Vec2(0.02, 10), 0.5, kPi}};
  const Image image = painter().paint(picture, bare()).value();
  EXPECT_LT(grey_at(image, Vec2(0.02, 10), 3, 0), kDark);
  EXPECT_LT(grey_at(image, Vec2(kBox, 10), 10, kPi), kDark);
}

TEST(Overlay, UnmarkedDefectsAreNotDrawn) {
  RodPicture with = empty_picture(kBox);
  with.found.defects = {{Vec2(6, 15), 0.5, 0}};
  PictureStyle style = bare();
  style.mark_defects = false;
  EXPECT_EQ(painter().paint(with, style).value(), painter().paint(empty_picture(kBox), style).value());
}

TEST(Overlay, NoTextOnTheRods) {
  RodPicture picture = empty_picture(kBox);
  for (int i = 0; i < 20; ++i) add_rod(picture, i, i, 0.3 * i);
  measure(picture, {});
  picture.frame.time = 1234.56;
  picture.captions.label = "rods.length=4.5 rods.area_fraction=0.80 plates.gamma=7 replica=3";
  picture.captions.history = {{0, 1000, 1234.56}, {0.2, 0.8, picture.found.order}, 0, 6000};
  RodsPass rods = RodsPass::create().value();
  for (const auto& [width, height] : {std::pair{1280, 720}, {1000, 1000}, {640, 360}, {800, 1200}, {1024, 768}}) {
    for (const std::string& colour : colour_names()) {
      PictureStyle style;
      style.width = width;
      style.height = height;
      style.colour = colour;
      const Image image = painter().paint(picture, style).value();
      const Layout layout = layout_of(style, {.history = true, .label = true});
      const Image alone = rods.draw(picture, style, layout.box_side, layout.box_side).value();
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
    const Layout layout = layout_of(style, {});
    const int y = static_cast<int>(layout.scale_bar.bottom() - 2.5 * layout.unit);
    int dark = 0;
    for (int x = layout.box_x + layout.box_side + 5; x < image.width; ++x) dark += image.pixel(x, y)[0] < 128;
    const double mm = dark * 83.73 / zoom / layout.box_side;
    EXPECT_NEAR(mm, zoom == 1 ? 20 : 10, 2 * 83.73 / zoom / layout.box_side);
  }
}

/// How high the bar over `value` is in the histogram of a picture's legend [pixels]; the scale goes from low to high.
int bar_height(const Image& image, const Layout& layout, double value, double low, double high) {
  const double left = 26 * layout.unit;
  const int x = static_cast<int>(layout.legend.x + left + (value - low) / (high - low) * (layout.legend.width - left));
  int coloured = 0;
  // Down to the axis: below it is the colour bar, which is there at every value.
  for (int y = static_cast<int>(layout.legend.y + 24); y < layout.legend.bottom() - 35; ++y) {
    const std::uint8_t* p = image.pixel(x, y);
    coloured += std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 12;
  }
  return coloured;
}

TEST(Overlay, TheLegendShowsHowManyRodsLeanEachWay) {
  // Two thirds of the rods at +12 degrees, one third at -24: the peaks' heights in the histogram are 2 to 1.
  RodPicture picture = empty_picture(kBox);
  const double degree = kPi / 180;
  for (int i = 0; i < 30; ++i) add_rod(picture, 0.6 * i, 0.6 * i, (i % 3 ? 12 : -24) * degree);
  PictureStyle style;
  style.colour = "layers";
  const Image image = painter().paint(picture, style).value();
  const Layout layout = layout_of(style, {});
  const auto height_at = [&](double degrees) { return bar_height(image, layout, degrees, -90, 90); };
  EXPECT_GT(height_at(12.5), 50);
  EXPECT_NEAR(height_at(-24.5) / double(height_at(12.5)), 0.5, 0.03);
  for (const double empty : {-85.0, -45.0, 3.0, 33.0, 85.0}) EXPECT_EQ(height_at(empty), 0) << empty;
}

TEST(Overlay, FilmsSayHowFastTheyPlay) {
  EXPECT_EQ(playback_text(0.1), "1/10 speed");
  EXPECT_EQ(playback_text(1.0 / 30), "1/30 speed");
  EXPECT_EQ(playback_text(1 / 1000.4), "1/1000 speed");
  EXPECT_EQ(playback_text(1 / 1000.5), "0.001\u00d7 speed");
  EXPECT_EQ(playback_text(0.15), "0.15\u00d7 speed");
  EXPECT_EQ(playback_text(1), "real time");
  EXPECT_EQ(playback_text(6), "6\u00d7 speed");
  EXPECT_EQ(playback_text(0), "");
}

TEST(Overlay, EveryStyleCanBeDrawnWithoutRods) {
  for (const Theme theme : {Theme::kLight, Theme::kDark, Theme::kPrint}) {
    for (const std::string& colour : colour_names()) {
      PictureStyle style;
      style.theme = theme;
      style.colour = colour;
      const Result<Image> image = painter().paint(empty_picture(kBox), style);
      ASSERT_TRUE(image);
      EXPECT_EQ(image->width, 1280);
      EXPECT_EQ(image->height, 720);
      EXPECT_EQ(image->pixel(0, 0)[0] < 128, theme == Theme::kDark);
    }
  }
}

TEST(Overlay, EachSpeciesIsShownWithItsNumberAndItsOrder) {
  RodPicture picture = empty_picture(kBox);
  picture.cell.shapes.push_back({{0}, {0.8}});
  picture.cell.shapes.push_back({{-0.4, 0.4}, {0.5, 0.3}});
  for (int i = 0; i < 6; ++i) {
    add_rod(picture, 3 * i + 1, 10, i == 4 ? kPi / 2 : 0);
    picture.cell.shape_of_rod.push_back(static_cast<std::uint8_t>(i / 2));
  }
  EXPECT_EQ(species_text(picture.cell, picture.frame, 0), "2 rods, S = 1.000");
  EXPECT_EQ(species_text(picture.cell, picture.frame, 1), "2 spheres");
  EXPECT_EQ(species_text(picture.cell, picture.frame, 2), "2 rods, S = 0.000") << "at right angles to each other";
  PictureStyle style;
  style.colour = "layers";
  for (const Number& number : numbers_of(picture, style)) {
    EXPECT_NE(number.name, "order S") << "of which of them?";
    EXPECT_NE(number.name, "length \u2113");
    EXPECT_TRUE(number.name != "bodies" || number.value == "6");
  }
}

TEST(Overlay, AZoomedViewCountsWhatIsInView) {
  RodPicture picture = empty_picture(20);
  for (int i = 0; i < 4; ++i) add_rod(picture, 1 + 5 * i, 10, 0);
  picture.found.defects = {{Vec2(1, 10), 0.5, 0}, {Vec2(11, 10), 0.5, 0}, {Vec2(1, 1), -0.5, 0}};
  PictureStyle style;
  const auto rods = [&] {
    for (const Number& number : numbers_of(picture, style)) {
      if (number.name == "rods") return number.value;
    }
    return std::string();
  };
  EXPECT_EQ(rods(), "4");
  EXPECT_EQ(defects_text(picture, style, 0.5), "+\u00bd defects: 2");
  style.zoom = 4;  // from 7.5 to 12.5 mm
  EXPECT_EQ(rods(), "1/4");
  EXPECT_EQ(defects_text(picture, style, 0.5), "+\u00bd defects: in view 1 of 2");
  EXPECT_EQ(defects_text(picture, style, -0.5), "\u2212\u00bd defects: in view 0 of 1");
  style.focus = Vec2(1, 0.5);  // across the border
  EXPECT_EQ(rods(), "1/4");
  style.view = ViewPoint::kOrbit;
  EXPECT_EQ(rods(), "4") << "such a view may show any of them";
}

TEST(Overlay, ALabelThatIsTooLongEndsInDots) {
  RodPicture picture = empty_picture(kBox);
  PictureStyle style;
  picture.captions.label = "a label of some words";
  const Image one = painter().paint(picture, style).value();
  for (int i = 0; i < 20; ++i) picture.captions.label += " and more";
  const Image cut = painter().paint(picture, style).value();
  EXPECT_NE(cut, one);
  const Layout layout = layout_of(style, {.label = true});
  const int y = static_cast<int>(layout.label.y + 15 * layout.unit) - 1;  // the dots stand on the line
  int last = 0;
  for (int x = 0; x < cut.width; ++x) {
    if (cut.pixel(x, y)[0] < 100) last = x;
  }
  EXPECT_LT(last, layout.label.right() + 1);
  EXPECT_GT(last, layout.label.right() - 100);
}

TEST(Overlay, AFilmHasABarThatGrows) {
  RodPicture picture = empty_picture(kBox);
  picture.captions.film_share = 0.25;
  const auto dark = [&](const PictureStyle& style) {
    const Image image = painter().paint(picture, style).value();
    int n = 0;
    for (int x = 0; x < image.width; ++x) n += image.pixel(x, image.height - 1)[0] < 100;
    return n;
  };
  EXPECT_NEAR(dark({}), 320, 1);
  picture.captions.film_share = 1;
  EXPECT_NEAR(dark({}), 1280, 1);
  PictureStyle style;
  style.time_bar = false;
  EXPECT_EQ(dark(style), 0);
}

}  // namespace overlay_test
}  // namespace shaken::render
