// SPDX-License-Identifier: MIT
#include "render/colourings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

constexpr double kDegree = kPi / 180;

const Colouring& by(const char* name) { return *find_colouring(name); }

double value(const char* name, const RodPicture& picture, std::size_t rod) { return by(name).value(picture, rod); }

TEST(Colourings, HaveNamesOfTheirOwnAndSoundRanges) {
  std::set<std::string> names;
  for (const Colouring& colouring : colourings()) {
    EXPECT_TRUE(names.insert(colouring.name).second) << colouring.name;
    EXPECT_STRNE(colouring.doc, "");
    EXPECT_STRNE(colouring.title, "");
    EXPECT_TRUE(colouring.scale == Scale::kNames || colouring.range.x() < colouring.range.y()) << colouring.name;
    EXPECT_TRUE(!colouring.has_middle || colouring.range.x() == -colouring.range.y()) << colouring.name;
    EXPECT_EQ(find_colouring(colouring.name), &colouring);
  }
  EXPECT_EQ(find_colouring("wheel"), nullptr);
  EXPECT_EQ(colour_names().size(), colourings().size() + 1);
}

TEST(Colourings, ValuesAreWhatTheirNamesSay) {
  RodPicture picture = empty_picture(20);
  add_rod(picture, 5, 5, 50 * kDegree, 0.2);
  add_rod(picture, 9, 5, 230 * kDegree, 0.2);  // head and tail changed
  add_rod(picture, 9, 9, -70 * kDegree);
  picture.found.director_angle = 40 * kDegree;
  picture.frame.velocity = {3 * picture.frame.director[0], 3 * picture.frame.director[0], Vec3(0, 0, 5)};
  EXPECT_NEAR(value("layers", picture, 0), 10, 1e-9);
  EXPECT_NEAR(value("layers", picture, 1), 10, 1e-9);
  EXPECT_NEAR(value("layers", picture, 2), 70, 1e-9) << "-110 is the same axis";
  EXPECT_NEAR(value("angle", picture, 1), 50, 1e-9);
  EXPECT_NEAR(value("angle", picture, 2), 110, 1e-9);
  EXPECT_TRUE(std::isnan(value("heading", picture, 1))) << "both ends are the same";
  picture.cell.shapes[0].radius.back() *= 0.9;
  EXPECT_NEAR(value("heading", picture, 1), 230, 1e-9);
  EXPECT_NEAR(value("heading", picture, 2), 290, 1e-9);
  EXPECT_NEAR(value("tilt", picture, 0), 0.2, 1e-12);
  EXPECT_NEAR(value("speed", picture, 0), 3, 1e-9);
  EXPECT_NEAR(value("speed", picture, 1), 3 * picture.frame.director[0].dot(picture.frame.director[1]), 1e-9);
  EXPECT_NEAR(value("speed", picture, 2), 0, 1e-9) << "across the axis";
  EXPECT_EQ(value("species", picture, 1), 0);
  EXPECT_EQ(value("id", picture, 2), 2);
  picture.frame.velocity.clear();
  EXPECT_TRUE(std::isnan(value("speed", picture, 0))) << "a live picture knows none";
  EXPECT_TRUE(std::isnan(value("order", picture, 0))) << "not asked for";
  EXPECT_TRUE(std::isnan(value("density", picture, 0))) << "not asked for";
}

TEST(Colourings, LocalOrderAndDensityOfAnOrderedHalf) {
  // A square lattice; to the right rods lie in all directions, and there are half as many.
  RodPicture picture = empty_picture(60);
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      if (i < 30) add_rod(picture, i + 0.5, j + 0.5, 0.4);
      if (i >= 30 && j % 2 == 0) add_rod(picture, i + 0.5, j + 0.5, 0.77 * i + 1.31 * j);
    }
  }
  measure(picture, {.field = true, .density = true});
  const auto near = [&](double x, double y) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < picture.n_rods(); ++i) {
      const auto away = [&](std::size_t k) { return (picture.frame.position[k].head<2>() - Vec2(x, y)).norm(); };
      if (away(i) < away(best)) best = i;
    }
    return best;
  };
  EXPECT_NEAR(value("order", picture, near(15, 30)), 1, 1e-6);
  EXPECT_LT(value("order", picture, near(45, 30)), 0.4);
  const double area = picture.cell.shapes[0].area();  // of a rod on each mm^2
  EXPECT_NEAR(value("density", picture, near(15, 30)), area, 0.01 * area);
  EXPECT_NEAR(value("density", picture, near(45, 30)), area / 2, 0.05 * area);
  EXPECT_NEAR(value("density", picture, near(15, 0)), area, 0.01 * area) << "across the border";
}

TEST(Colourings, RodsWithoutAValueHaveTheColourOfTheirSpecies) {
  RodPicture picture = empty_picture(20);
  picture.cell.shapes.push_back({{0}, {0.5}});
  picture.cell.shapes.push_back({{-1, 1}, {0.3, 0.2}});
  add_rod(picture, 5, 5, 0.3);
  add_rod(picture, 9, 5, 0.3);
  add_rod(picture, 9, 9, 0.3);
  picture.cell.shape_of_rod = {0, 1, 2};
  for (const char* name : {"layers", "angle"}) {
    EXPECT_EQ(rod_colour(picture, 1, by(name), by(name).range, Palette::kSafe), species_colour(1)) << name;
    EXPECT_EQ(rod_colour(picture, 2, by(name), by(name).range, Palette::kSafe), species_colour(2)) << name;
  }
  EXPECT_EQ(rod_colour(picture, 1, by("heading"), {0, 360}, Palette::kSafe), species_colour(1))
      << "a sphere has no head";
  EXPECT_EQ(rod_colour(picture, 2, by("heading"), {0, 360}, Palette::kSafe), heading_colour(0.3)) << "this rod has one";
  EXPECT_EQ(rod_colour(picture, 0, by("speed"), {-20, 20}, Palette::kSafe), no_value_colour());
  EXPECT_NE(rod_colour(picture, 0, by("species"), {0, 2}, Palette::kSafe),
            rod_colour(picture, 1, by("species"), {0, 2}, Palette::kSafe));
}

TEST(ChosenColour, FollowsTheOrder) {
  RodPicture picture = empty_picture(20);
  EXPECT_EQ(chosen_colour(picture, std::vector<double>{0.9}, true), "layers");
  EXPECT_EQ(chosen_colour(picture, std::vector<double>{0.69}, true), "angle");
  EXPECT_EQ(chosen_colour(picture, {}, true), "angle");
  picture.found.defects = {{Vec2(1, 1), 0.5, 0}};
  EXPECT_EQ(chosen_colour(picture, std::vector<double>{0.9}, true), "angle");
  EXPECT_EQ(chosen_colour(picture, std::vector<double>{0.9}, false), "layers");
  picture.found.defects.clear();
  std::vector<double> film(10, 0.9);
  film[0] = 0.1;
  EXPECT_EQ(chosen_colour(picture, film, true), "layers") << "nine of ten";
  film[1] = 0.1;
  EXPECT_EQ(chosen_colour(picture, film, true), "angle");
  picture.cell.shapes = {{{0}, {0.5}}};
  EXPECT_EQ(chosen_colour(picture, std::vector<double>{0.9}, true), "species") << "spheres";
}

TEST(AskedBy, NothingThatTheStyleDoesNotNeed) {
  PictureStyle style;
  style.mark_defects = false;
  for (const char* plain : {"auto", "angle", "layers", "heading", "tilt", "speed", "species", "id"}) {
    style.colour = plain;
    const Asked asked = asked_by(style);
    EXPECT_FALSE(asked.defects || asked.field || asked.density) << plain;
  }
  style.colour = "order";
  EXPECT_TRUE(asked_by(style).field);
  style.colour = "density";
  EXPECT_TRUE(asked_by(style).density);
  style.colour = "angle";
  style.lines = FieldLines::kBars;
  EXPECT_TRUE(asked_by(style).field);
}

}  // namespace
}  // namespace shaken::render
