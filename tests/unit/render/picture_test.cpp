#include "render/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "render/colourings.h"
#include "render/style.h"
#include "render/view.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

TEST(RodPicture, LengthIsTipToTip) { EXPECT_DOUBLE_EQ(empty_picture(10).rod_length(), 4.5); }

TEST(RodPicture, AreaFractionOfThePapersSystem) {
  // Sharma & Soni (2024): 2109 rods of 4.5 mm in a box of 83.73 mm make 0.75, to within one rod.
  RodPicture picture = empty_picture(83.73);
  picture.frame.position.resize(2109);
  EXPECT_NEAR(picture.area_fraction(), 0.75, 0.75 / 2109);
}

TEST(RodPicture, AreaFractionOfARectangle) {
  RodPicture picture = empty_picture(83.73);
  picture.cell.box = {21, 126};
  picture.frame.position.resize(100);
  const double square = empty_picture(10).cell.shapes[0].area() * 100 / (21 * 126);
  EXPECT_NEAR(picture.area_fraction(), square, 1e-12);
}

TEST(View, OfARectangleIsASquareOfItsImages) {
  RodPicture picture = empty_picture(10);
  picture.cell.box = {10, 40};
  PictureStyle style;
  const View view = view_of(picture, style);
  EXPECT_EQ(view.side, 40);
  EXPECT_EQ(view.corner, Vec2(-15, 0));
  EXPECT_EQ(view.period, Vec2(10, 40));
  EXPECT_EQ(framed_in(picture, style).corner, Vec2(15, 0));
  EXPECT_EQ(framed_in(picture, style).sides, Vec2(10, 40));
  std::vector<double> seen;
  for_images(view, Vec2(6, 20), 0, [&](const Vec2& at) {
    seen.push_back(at.x());
    EXPECT_EQ(at.y(), 20);
  });
  EXPECT_EQ(seen, (std::vector<double>{1, 11, 21, 31}));
  style.zoom = 4;
  EXPECT_EQ(view_of(picture, style).side, 10);
  EXPECT_EQ(view_of(picture, style).corner, Vec2(0, 15));
  style.zoom = 1;
  style.whole = true;  // the box alone
  EXPECT_EQ(view_of(picture, style).period, Vec2(0, 0));
  EXPECT_EQ(framed_in(picture, style).sides, Vec2(10, 40));
  EXPECT_LT((view_of(picture, style).corner + framed_in(picture, style).corner).norm(), 1e-12);
}

TEST(RodPicture, AreaFractionOfASphereIsADiscs) {
  RodPicture picture;
  picture.cell.box = 2;
  picture.cell.shapes = {{{0}, {0.5}}};
  picture.frame.position.resize(1);
  EXPECT_NEAR(picture.area_fraction(), kPi * 0.25 / 4, 1e-12);
}

TEST(RodPicture, AreaFractionIsOfAllKindsAndPerArena) {
  RodPicture picture;
  picture.cell.box = 40;
  picture.cell.shapes = {{{0}, {0.5}}, {{0}, {1}}};
  picture.cell.shape_of_rod = {1, 0, 1};
  picture.frame.position.resize(3);
  const double discs = kPi * (0.25 + 1 + 1);
  EXPECT_NEAR(picture.area_fraction(), discs / 1600, 1e-12);
  for (const auto& [arena, area] : {std::pair{Arena::kDisc, kPi * 225},
                                    {Arena::kSquare, 900.0},
                                    {Arena::kAnnulus, kPi * 200},
                                    {Arena::kStadium, kPi * 225 + 150},
                                    {Arena::kChannel, 1200.0},
                                    {Arena::kEllipse, kPi * 37.5},
                                    {Arena::kWedge, 80.0}}) {
    picture.cell.walls = SideWalls{.arena = arena, .size = 30, .inner = 10, .length = 5, .narrow = 2};
    EXPECT_NEAR(picture.area_fraction(), discs / area, 1e-12);
  }
}

TEST(RodPicture, LengthOfRodsThatDifferHasADeviation) {
  RodPicture picture;
  picture.cell.shapes = {{{-2, 0, 2}, {0.25, 0.4, 0.25}}};
  picture.frame.position.resize(4);
  EXPECT_EQ(picture.length_text(), "4.5 mm");
  picture.cell.shapes.push_back({{-2.2, 0, 2.2}, {0.25, 0.4, 0.25}});
  picture.cell.shapes.push_back({{-1.8, 0, 1.8}, {0.25, 0.4, 0.25}});
  picture.cell.shapes.push_back({{0}, {0.4}});
  picture.cell.species_of_shape = {0, 0, 0, 1};
  picture.cell.shape_of_rod = {0, 1, 2, 3};  // sqrt(2/3) of 0.4 mm
  EXPECT_EQ(picture.length_text(), "4.5\u00b10.33 mm");
  EXPECT_EQ(picture.count(0), 3u);
  EXPECT_EQ(picture.count_of_shape(0), 1u);
}

TEST(RodPicture, LengthOfARodWithAHeadIsTipToTip) {
  RodPicture picture;
  picture.cell.shapes = {{{-1.5, 0.5, 2.5}, {0.5, 0.4, 0.3}}};
  EXPECT_DOUBLE_EQ(picture.rod_length(), 4.8);
}

TEST(Measure, AsksOnlyRodsOfTheFirstKind) {
  RodPicture picture = empty_picture(20);
  picture.cell.shapes.push_back({{0}, {0.5}});
  for (int i = 0; i < 40; ++i) {
    add_rod(picture, 0.5 * i, 0.5 * i, i % 2 ? 0.7 : 0.13 * i);
    picture.cell.shape_of_rod.push_back(i % 2 ? 0 : 1);
  }
  measure(picture, {.defects = true});
  EXPECT_NEAR(picture.found.director_angle, 0.7, 1e-12);
  EXPECT_NEAR(picture.found.order, 1, 1e-12);
  EXPECT_TRUE(picture.found.defects.empty());
}

TEST(Measure, FindsOrderAndDirector) {
  RodPicture picture = empty_picture(20);
  for (int i = 0; i < 40; ++i) add_rod(picture, 0.5 * i, 0.5 * i, 0.7 + (i % 2 ? 0.2 : -0.2));
  measure(picture, {});
  EXPECT_NEAR(picture.found.director_angle, 0.7, 1e-12);
  EXPECT_NEAR(picture.found.order, std::cos(0.4), 1e-12);
  EXPECT_TRUE(picture.found.defects.empty());
}

TEST(Measure, FindsAPlantedPairOfDefects) {
  // Director theta = (angle about A - angle about B) / 2: +1/2 at A, -1/2 at B, uniform far away.
  RodPicture picture = empty_picture(60);
  const Vec2 a(22, 30), b(38, 30);
  for (double x = 0.5; x < 60; x += 1) {
    for (double y = 0.5; y < 60; y += 1) {
      const Vec2 to_a = Vec2(x, y) - a, to_b = Vec2(x, y) - b;
      add_rod(picture, x, y, 0.5 * (std::atan2(to_a.y(), to_a.x()) - std::atan2(to_b.y(), to_b.x())));
    }
  }
  measure(picture, {.defects = true});
  ASSERT_EQ(picture.found.defects.size(), 2u);
  for (const analysis::Defect& defect : picture.found.defects) {
    EXPECT_LT((defect.position - (defect.charge > 0 ? a : b)).norm(), 1.0);
  }
  EXPECT_EQ(picture.found.defects[0].charge + picture.found.defects[1].charge, 0);
  measure(picture, {});
  EXPECT_TRUE(picture.found.defects.empty());

  measure(picture, {.defects = true, .smoothing = 20, .grid = 1});  // as the run had it: more than the pair is apart
  EXPECT_TRUE(picture.found.defects.empty());
}

// One bead is a sphere: its director means nothing.
TEST(Measure, FindsNeitherOrderNorDefectsOfSpheres) {
  RodPicture picture = empty_picture(40);
  picture.cell.shapes = {{{0}, {0.4}}};
  for (int i = 0; i < 400; ++i) add_rod(picture, 2 * (i % 20) + 1, 2 * (i / 20) + 1, 0.9 * i * i);
  measure(picture, {.defects = true, .field = true});
  EXPECT_FALSE(picture.cell.has_axes());
  EXPECT_TRUE(std::isnan(picture.found.order));
  EXPECT_TRUE(picture.found.defects.empty());
  EXPECT_EQ(picture.found.field, nullptr);
  EXPECT_STREQ(colouring_of(picture, {}).name, "species");
  // Whatever is asked for that needs axes leaves the picture as it is without.
  PictureStyle bare;
  bare.mark_defects = false;
  bare.rods = 0.5;
  PictureStyle marks = bare, lines = bare, ground = bare, inset = bare;
  marks.mark_defects = true;
  lines.lines = FieldLines::kStreamlines;
  ground.background = Background::kOrder;
  inset.inset = Inset::kAngles;
  const Image without = painter().paint(picture, bare).value();
  for (const PictureStyle& style : {marks, lines, ground, inset}) {
    const auto with = painter().paint(picture, style);
    ASSERT_TRUE(with) << with.error().message;
    EXPECT_EQ(*with, without);
  }
}

TEST(Measure, FindsNoDefectsBeyondTheWalls) {
  const auto is_inside = [](Arena arena, const Vec2& from_middle) {
    if (arena == Arena::kSquare) return from_middle.cwiseAbs().maxCoeff() < 20;
    if (arena == Arena::kChannel) return std::abs(from_middle.y()) < 20;
    if (arena == Arena::kStadium)
      return Vec2(std::max(0.0, std::abs(from_middle.x()) - 8), from_middle.y()).norm() < 20;
    if (arena == Arena::kEllipse) return Vec2(from_middle.x() / 28, from_middle.y() / 20).norm() < 1;
    if (arena == Arena::kWedge)
      return std::abs(from_middle.x()) < 28 && std::abs(from_middle.y()) < 10 * (1 - from_middle.x() / 28);
    return from_middle.norm() < 20 && (arena == Arena::kDisc || from_middle.norm() > 8);
  };
  const auto rods_within = [&](const std::optional<SideWalls>& walls) {
    RodPicture picture = empty_picture(60);
    picture.cell.walls = walls;
    for (int i = 0; i < 900; ++i) {
      const Vec2 place(2 * (i % 30) + 1, 2 * (i / 30) + 1);
      if (!walls || is_inside(walls->arena, place - Vec2(30, 30))) add_rod(picture, place.x(), place.y(), 0.9 * i * i);
    }
    measure(picture, {.defects = true});
    return picture;
  };
  const std::vector<analysis::Defect> everywhere = rods_within({}).found.defects;
  for (const auto& [name, arena] : kArenaNames) {
    const double length = arena == Arena::kStadium ? 16 : 56;
    const RodPicture picture = rods_within(SideWalls{.arena = arena, .size = 40, .inner = 16, .length = length});
    EXPECT_FALSE(picture.found.defects.empty());
    EXPECT_LT(picture.found.defects.size(), everywhere.size());
    for (const analysis::Defect& defect : picture.found.defects) {
      EXPECT_TRUE(is_inside(arena, defect.position - Vec2(30, 30)));
    }
  }
}

TEST(Measure, NoRods) {
  RodPicture picture = empty_picture(10);
  measure(picture, {.defects = true});
  EXPECT_EQ(picture.found.order, 0);
  EXPECT_TRUE(picture.found.defects.empty());
}

TEST(PictureStyle, SizesThatCannotBeAreRefused) {
  const auto good = [](int width, int height, double zoom = 1) {
    PictureStyle style;
    style.width = width;
    style.height = height;
    style.zoom = zoom;
    return static_cast<bool>(check(style));
  };
  EXPECT_TRUE(good(1280, 720));
  EXPECT_TRUE(good(64, 7680));
  EXPECT_FALSE(good(63, 720));
  EXPECT_FALSE(good(1280, 7681));
  EXPECT_FALSE(good(-1280, -720));
  EXPECT_FALSE(good(1280, 720, 0.5));
  EXPECT_FALSE(good(1280, 720, std::nan("")));
}

}  // namespace
}  // namespace shaken::render
