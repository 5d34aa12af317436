#include "render/colourings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "render/headline.h"
#include "render/style_file.h"
#include "render/style_keys.h"
#include "tests/support/generated_page.h"
#include "tests/support/good.h"
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

std::string problems_of(const std::string& text) {
  const keys::Loaded<PictureStyle> style = load_style(text, "mine.json", {});
  return style ? "" : to_string(style.error());
}

TEST(StyleFile, SetsWhatItNames) {
  const auto loaded = load_style(R"({
    // a comment
    "style": "defects", "colour": "speed", "range": [-5, 5], "size": [640, 480], "tracks": "500 ms",
    "theme": "dark", "palette": "paper", "view": "follow:12", "legend": false, "speed": 0.1, "focus": [0.25, 0.75]
  })",
                                 "mine.json", {});
  ASSERT_TRUE(loaded) << to_string(loaded.error());
  EXPECT_EQ(loaded->colour, "speed");
  EXPECT_EQ(loaded->range, Vec2(-5, 5));
  EXPECT_EQ(loaded->width, 640);
  EXPECT_EQ(loaded->height, 480);
  EXPECT_DOUBLE_EQ(loaded->tracks, 0.5);
  EXPECT_EQ(loaded->theme, Theme::kDark);
  EXPECT_EQ(loaded->palette, Palette::kPaper);
  EXPECT_EQ(loaded->followed, 12);
  EXPECT_DOUBLE_EQ(loaded->zoom, 4) << "a close-up";
  EXPECT_FALSE(loaded->legend);
  EXPECT_EQ(loaded->speed, 0.1);
  EXPECT_EQ(loaded->background, Background::kOrder) << "from the preset";
  EXPECT_TRUE(loaded->mark_defects);
}

TEST(StyleFile, TellsAllProblemsAtOnceWithTheirPlaces) {
  EXPECT_EQ(problems_of("{\n  \"colour\": \"tlit\",\n  \"colr\": \"tilt\",\n  \"zoom\": 0.5,\n"
                        "  \"size\": [1280],\n  \"legend\": 1, \"rods\": \"half\"\n}"),
            "mine.json:2:13: /colour: \"tlit\" is not one of \"auto\", \"angle\", \"layers\", \"heading\", \"tilt\", "
            "\"speed\", \"order\", \"density\", \"species\", \"id\"; did you mean tilt?\n"
            "mine.json:3:3: /colr: unknown key; did you mean colour?\n"
            "mine.json:4:11: /zoom: 0.5 is outside [1, 1000]\n"
            "mine.json:5:11: /size: expected [width, height], not an array\n"
            "mine.json:6:13: /legend: expected true or false, not the number 1\n"
            "mine.json:6:24: /rods: \"half\" is not a number\n");
}

TEST(StyleFile, RefusesWhatContradictsItself) {
  EXPECT_NE(problems_of(R"({"colour": "layers", "range": [-30, 30]})").find("fixed"), std::string::npos);
  EXPECT_NE(problems_of(R"({"colour": "tilt", "range": [-0.1, 0.3]})").find("0 in its middle"), std::string::npos);
  EXPECT_NE(problems_of(R"({"range": [0, 1]})").find("not auto"), std::string::npos);
  EXPECT_NE(problems_of(R"({"colour": "order", "range": [1, 0]})").find("rise"), std::string::npos);
  EXPECT_NE(problems_of(R"({"background": "order"})").find("hidden"), std::string::npos);
  EXPECT_NE(problems_of(R"({"view": "follow:x"})").find("follow:N"), std::string::npos);
  EXPECT_NE(problems_of(R"({"view": "orbit:10"})").find("orbit:AZIMUTH,ELEVATION"), std::string::npos);
  for (const std::string orbit : {"10,95", "10,0.5", "361,20", "-361,20"})
    EXPECT_NE(problems_of(R"({"view": "orbit:)" + orbit + "\"}").find("from 1 to 90"), std::string::npos) << orbit;
  EXPECT_NE(problems_of(R"({"style": "deffects"})").find("did you mean defects?"), std::string::npos);
  EXPECT_NE(problems_of(R"([1])").find("object"), std::string::npos);
  EXPECT_NE(problems_of("{").find("mine.json:1"), std::string::npos);
  EXPECT_NE(problems_of(R"({"zoom": 2, "zoom": 3})"), "");
}

TEST(StyleFile, PresetsAreSound) {
  for (const Preset& preset : presets()) {
    const auto style = test::good(load_style(preset.text, preset.name, {}));
    EXPECT_TRUE(check(*style)) << preset.name;
    EXPECT_TRUE(named_style(preset.name, {})) << preset.name;
  }
}

TEST(NamedStyle, IsAPresetOrAFile) {
  const ScratchFolder folder;
  std::ofstream(folder / "mine.json") << R"({"zoom": 3})";
  EXPECT_DOUBLE_EQ(named_style((folder / "mine.json").string(), {})->zoom, 3);
  EXPECT_THAT(test::refusal(named_style("layer", {})), testing::HasSubstr("did you mean layers?"));
}

TEST(StyleKeys, EachTakesItsOwnDefaultBack) {
  for (const StyleKey& key : style_keys()) {
    if (key.fallback.index() == 0) continue;  // not given by default
    PictureStyle style;
    key.store(style, key.fallback);
    EXPECT_EQ(key.fetch(style), key.fallback) << key.path;
  }
}

TEST(StyleKeys, TextsOfTheCommandLine) {
  PictureStyle style;
  const auto put = [&](const char* key, const char* text) {
    const auto done = set_from_text(style, style_keys().at(key), text);
    return done ? std::string() : done.error().message;
  };
  EXPECT_EQ(put("size", "1920x1080"), "");
  EXPECT_EQ(style.height, 1080);
  EXPECT_EQ(put("focus", "0.3,0.2"), "");
  EXPECT_EQ(style.focus, Vec2(0.3, 0.2));
  EXPECT_EQ(put("size", "1920"), "expected WxH, not \"1920\"");
  EXPECT_EQ(put("size", "10x10"), "10 is outside [64, 7680]");
  EXPECT_EQ(put("size", "1280x720x3"), "\"720x3\" is not a number");
  EXPECT_EQ(put("zoom", "nan"), "\"nan\" is not a number");
  EXPECT_EQ(put("theme", "grey"), "\"grey\" is not one of \"light\", \"dark\", \"print\"");
}

TEST(Headline, SpeaksTheLanguageOfTheField) {
  EXPECT_EQ(headline("rods.area_fraction=0.8 rods.length=2.5"), "\u03c6 = 0.8, \u2113 = 2.5 mm");
  EXPECT_EQ(headline("plates.gamma=7 plates.frequency=200 replica=3"), "\u0393 = 7, f = 200 Hz, replica 3");
  EXPECT_EQ(headline("box.gap=1.4mm"), "w = 1.4 mm") << "as in plots, in physics.md and in the paper";
  EXPECT_EQ(headline("contacts.rod_base.friction=0.3"), "friction = 0.3");
  EXPECT_EQ(headline("My run, at a=b"), "My run, at a=b");
  EXPECT_EQ(headline(""), "");
}

// What the loader accepts, and no more than it says of forms and ranges.
TEST(StyleSchema, KnowsEveryKey) {
  const nlohmann::ordered_json schema = style_schema();
  for (const StyleKey& key : style_keys()) EXPECT_TRUE(schema["properties"].contains(key.path)) << key.path;
}

TEST(Docs, PicturesNameEveryColourKeyAndPreset) {
  const std::string page = SHAKEN_SOURCE_DIR "/docs/pictures.md";
  expect_generated(page, "colours", colourings_as_markdown());
  expect_generated(page, "style keys", style_keys().as_markdown());
  expect_generated(page, "presets", presets_as_markdown());
}

}  // namespace
}  // namespace shaken::render
