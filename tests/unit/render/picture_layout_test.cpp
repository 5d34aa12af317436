#include "render/picture_layout.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "render/panels.h"

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
      for (const int more : {0, 1, 2, 3, 4, 5, 6, 7}) {
        const bool label = more % 2 == 1, shape_of_rod = more / 2 % 2 == 1;
        PictureStyle style;
        if (more >= 4) {
          style.tracks = 2;
          style.inset = Inset::kAngles;
        }
        style.width = width;
        style.height = height;
        const Layout layout = layout_of(style, {.history = history, .label = label, .species = shape_of_rod ? 3 : 0});
        const Rect box{double(layout.box_x), double(layout.box_y), double(layout.box_side), double(layout.box_side)};
        const std::vector<Rect> all = {box,
                                       layout.label,
                                       layout.numbers,
                                       layout.history,
                                       layout.legend,
                                       layout.key,
                                       layout.scale_bar,
                                       layout.species,
                                       layout.ground,
                                       layout.is_inset_on_rods ? Rect{} : layout.inset};
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
        EXPECT_EQ(layout.label.width > 0, label);
        EXPECT_EQ(layout.species.width > 0, shape_of_rod);
      }
    }
  }
}

TEST(Layout, TheInsetIsInTheColumnOrLiesOnTheRods) {
  const auto within = [](const Rect& inner, const Rect& outer) {
    return inner.x >= outer.x && inner.y >= outer.y && inner.right() <= outer.right() &&
           inner.bottom() <= outer.bottom();
  };
  PictureStyle style;
  EXPECT_EQ(layout_of(style, {}).inset.width, 0);
  style.inset = Inset::kAngles;
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{480, 270}, {1280, 720}, {270, 480}}) {
    style.width = width;
    style.height = height;
    const Layout top = layout_of(style, {}), gap = stage_layout_of(style, {});
    EXPECT_GT(top.inset.width, 0);
    EXPECT_EQ(top.is_inset_on_rods, width < 1280);
    const Rect box{double(top.box_x), double(top.box_y), double(top.box_side), double(top.box_side)};
    EXPECT_EQ(within(top.inset, box), top.is_inset_on_rods);
    if (gap.inset.width > 0) {
      EXPECT_TRUE(within(gap.inset, {0, 0, double(gap.stage_width), double(gap.stage_height)}));
    }
    for (const Layout& panel : panel_grid(style, 2).panels) {
      if (panel.inset.width == 0) continue;
      const auto side = double(panel.box_side);
      EXPECT_TRUE(within(panel.inset, {double(panel.box_x), double(panel.box_y), side, side}));
    }
  }
  style.width = style.height = 100;
  EXPECT_EQ(layout_of(style, {}).inset.width, 0) << "there is no room";
}

TEST(PanelGrid, NothingOverlapsOrLeavesThePicture) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{640, 360}, {1280, 720}, {720, 720}, {800, 1200}, {1920, 400}, {400, 1600}}) {
    for (const bool bare : {false, true}) {
      PictureStyle style;
      style.width = width;
      style.height = height;
      if (bare) style.caption = style.legend = style.scale_bar = false;
      for (std::size_t n = 2; n <= 9; ++n) {
        const PanelGrid grid = panel_grid(style, n);
        ASSERT_EQ(grid.panels.size(), n);
        std::vector<Rect> all{grid.footer};
        for (const Layout& panel : grid.panels) {
          EXPECT_EQ(panel.box_side, grid.panels[0].box_side) << "runs are compared in boxes of one size";
          all.push_back({double(panel.box_x), double(panel.box_y), double(panel.box_side), double(panel.box_side)});
          all.push_back(panel.label);
          all.push_back(panel.scale_bar);
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
          if (all[i].width == 0) continue;
          const std::string where = std::to_string(i) + " of " + std::to_string(n) + " in " + std::to_string(width);
          EXPECT_GE(all[i].x, 0) << where;
          EXPECT_GE(all[i].y, 0) << where;
          EXPECT_LE(all[i].right(), width + 1) << where;
          EXPECT_LE(all[i].bottom(), height + 1) << where;
          // boxes stand on whole pixels, words do not
          Rect inner = all[i];
          inner.x += 1, inner.y += 1, inner.width -= 2, inner.height -= 2;
          for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(inner, all[j])) << where << " and " << j;
        }
        EXPECT_EQ(grid.footer.width > 0, !bare);
      }
    }
  }
}

TEST(Panels, HaveOneClockOnlyIfTheyAreOfOneTime) {
  RodPicture picture;
  picture.frame.time = 120;
  picture.beside.resize(2);
  for (RodPicture& other : picture.beside) other.frame.time = 120.001;
  EXPECT_TRUE(have_one_time(picture));
  picture.beside[1].frame.time = 300;
  EXPECT_FALSE(have_one_time(picture)) << "then each panel says its own";
}

TEST(PanelGrid, FitsTheShapeOfThePicture) {
  PictureStyle style;
  style.width = 1600;
  style.height = 500;
  const PanelGrid wide = panel_grid(style, 3);
  EXPECT_EQ(wide.panels[0].box_y, wide.panels[2].box_y) << "in a row";
  std::swap(style.width, style.height);
  const PanelGrid tall = panel_grid(style, 3);
  EXPECT_EQ(tall.panels[0].box_x, tall.panels[2].box_x) << "in a column";
  style.width = style.height = 1000;
  const PanelGrid square = panel_grid(style, 4);
  EXPECT_EQ(square.panels[0].box_y, square.panels[1].box_y);
  EXPECT_EQ(square.panels[0].box_x, square.panels[2].box_x);
}

TEST(Layout, TheBoxIsMostOfAWidePicture) {
  PictureStyle style;
  EXPECT_GE(layout_of(style, {.history = true, .label = true}).box_side, 670);
}

TEST(Layout, WordsStandBesideTheRodsInAVeryWidePictureAndBelowThemInATallOne) {
  PictureStyle style;
  style.width = 1600;
  style.height = 400;
  const Contents all{.history = true, .label = true};
  const Layout wide = layout_of(style, all);
  EXPECT_LT(wide.numbers.x - (wide.box_x + wide.box_side), 60);
  EXPECT_NEAR(wide.box_x, style.width - wide.numbers.right(), 60) << "in the middle";
  style.width = 400;
  style.height = 800;
  const Layout tall = layout_of(style, all);
  EXPECT_GT(tall.box_side, 350);
  for (const Rect& place : {tall.numbers, tall.legend}) EXPECT_GT(place.width, 350);
  EXPECT_GT(tall.legend.y, tall.numbers.y + 10);
}

TEST(Layout, ABarePictureMayHaveAScaleBarOnItsRods) {
  PictureStyle style;
  style.caption = style.legend = false;
  const Layout layout = layout_of(style, {});
  EXPECT_TRUE(layout.is_bar_on_rods);
  EXPECT_EQ(layout.box_side, style.height);
  EXPECT_GT(layout.scale_bar.x, layout.box_x);
  EXPECT_LT(layout.scale_bar.bottom(), layout.box_y + layout.box_side);
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
