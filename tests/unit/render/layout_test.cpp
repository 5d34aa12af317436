// SPDX-License-Identifier: MIT
#include "render/layout.h"

#include <gtest/gtest.h>

#include <vector>

namespace shaken::render {
namespace {

bool overlap(const Rect& a, const Rect& b) {
  constexpr double kTouch = 1e-6;
  return a.width > 0 && b.width > 0 && a.x < b.right() - kTouch && b.x < a.right() - kTouch &&
         a.y < b.bottom() - kTouch && b.y < a.bottom() - kTouch;
}

TEST(Layout, NothingOverlapsOrLeavesThePicture) {
  const std::vector<std::pair<int, int>> sizes = {{640, 360},   {854, 480},   {1280, 720},  {1920, 1080},
                                                  {3840, 2160}, {1024, 768},  {1000, 1000}, {720, 720},
                                                  {800, 1200},  {1080, 1920}, {2000, 1500}, {1500, 600}};
  for (const auto& [width, height] : sizes) {
    for (const bool history : {false, true}) {
      for (const int more : {0, 1, 2, 3}) {
        const bool label = more % 2 == 1, species_of_rod = more >= 2;
        PictureStyle style;
        style.width = width;
        style.height = height;
        const Layout layout = layout_of(style, {.history = history, .label = label, .species = species_of_rod});
        const Rect box{double(layout.box_x), double(layout.box_y), double(layout.box_side), double(layout.box_side)};
        const std::vector<Rect> all = {box,           layout.label, layout.numbers,   layout.history,
                                       layout.legend, layout.key,   layout.scale_bar, layout.species};
        for (std::size_t i = 0; i < all.size(); ++i) {
          if (all[i].width == 0) continue;
          EXPECT_GT(all[i].height, 0) << i << " in " << width << 'x' << height;
          EXPECT_GE(all[i].x, 0) << i << " in " << width << 'x' << height;
          EXPECT_GE(all[i].y, 0) << i << " in " << width << 'x' << height;
          EXPECT_LE(all[i].right(), width + 1e-6) << i << " in " << width << 'x' << height;
          EXPECT_LE(all[i].bottom(), height + 1e-6) << i << " in " << width << 'x' << height;
          for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(overlap(all[i], all[j])) << i << " and " << j << " in " << width << 'x' << height;
          }
        }
        EXPECT_GT(layout.legend.width, 0);
        EXPECT_EQ(layout.label.width > 0, label);
        EXPECT_EQ(layout.species.width > 0, species_of_rod);
      }
    }
  }
}

TEST(Layout, TheBoxIsMostOfAWidePicture) {
  PictureStyle style;
  EXPECT_GE(layout_of(style, {.history = true, .label = true}).box_side, 670);
}

TEST(Layout, ABarePictureIsAllBox) {
  PictureStyle style;
  style.width = style.height = 500;
  style.caption = style.legend = style.scale_bar = false;
  const Layout layout = layout_of(style, {.history = true, .label = true});
  EXPECT_EQ(layout.box_side, 500);
  EXPECT_EQ(layout.box_x, 0);
  EXPECT_EQ(layout.key.width, 0);
  EXPECT_EQ(layout.history.width, 0);
}

}  // namespace
}  // namespace shaken::render
