// Whole pictures of every style and view, compared with those in golden/. With the libraries of Debian 12 they are the
// same to the last bit; with others they have to look the same. SHAKEN_UPDATE_DOCS=1 draws them anew: look at them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

#include "render/colourings.h"
#include "render/gl.h"
#include "render/png.h"
#include "render/style_file.h"
#include "tests/unit/render/render_support.h"
//
#include <cairo.h>

namespace shaken::render {
namespace {

const std::string kFolder = SHAKEN_SOURCE_DIR "/tests/unit/render/golden/";
constexpr const char* kMesa = "Mesa 22.3.6";
constexpr const char* kCairo = "1.16.0";

/// Numbers that look random and are the same everywhere.
class Scatter {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }

 private:
  std::uint64_t state_ = 1;
};

/// Rods on a lattice, about as dense as they are in a run; `angle` gives each one's direction.
RodPicture lattice(int columns, int rows, const std::function<double(double, double)>& angle) {
  RodPicture picture = empty_picture(4.7 * columns);
  Scatter scatter;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double x = (i + 0.5 * (j % 2) + 0.1 * scatter.next()) * 4.7, y = (j + 0.5) * picture.cell.box.y() / rows;
      // one draw a line: compilers evaluate arguments in different orders
      const double tilt = 0.3 * (scatter.next() - 0.5);
      const double turn = 0.1 * (scatter.next() - 0.5);
      add_rod(picture, x, y, angle(x, y) + turn, tilt);
      picture.frame.velocity.emplace_back(30 * (scatter.next() - 0.5), 0, 0);
    }
  }
  picture.captions.label = "\u03c6 = 0.8, \u2113 = 4.5 mm";
  picture.captions.subtitle = "\u0393 = 7, f = 200 Hz";
  picture.frame.time = 12.34;
  picture.frame.base = 0.04;
  return picture;
}

RodPicture layered() {
  return lattice(8, 36, [](double, double y) { return std::fmod(y, 12) < 6 ? 0.2 : -0.2; });
}

/// +1/2 and -1/2.
RodPicture paired() {
  const Vec2 a(12, 19), b(26, 19);
  return lattice(8, 36, [=](double x, double y) {
    return 0.5 * (std::atan2(y - a.y(), x - a.x()) - std::atan2(y - b.y(), x - b.x())) + 0.4;
  });
}

RodPicture mixed() {
  RodPicture picture = empty_picture(32);
  picture.cell.walls = SideWalls{Arena::kDisc, 30};
  picture.cell.shapes.push_back({{-1.2, -0.4, 0.4, 1.2}, {0.45, 0.4, 0.35, 0.2}});
  picture.cell.shapes.push_back({{0}, {0.5}});
  for (int i = 0; i < 120; ++i) {
    const double r = 13 * std::sqrt((i + 0.5) / 120), turn = 2.39996 * i;
    add_rod(picture, 16 + r * std::cos(turn), 16 + r * std::sin(turn), turn);
    picture.cell.shape_of_rod.push_back(static_cast<std::uint8_t>(i % 3));
  }
  return picture;
}

RodPicture one_large_rod() {
  RodPicture picture = empty_picture(6);
  add_rod(picture, 3, 3, 0.3);
  return picture;
}

struct Case {
  const char* name;
  std::function<RodPicture()> picture;
  const char* style;  ///< JSON

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

const Case kCases[] = {
    {"layers", layered, R"({"style": "layers"})"},
    {"layers_of_the_paper", layered, R"({"style": "layers", "palette": "paper"})"},
    {"layers_tall_dark", layered, R"({"style": "layers", "theme": "dark", "size": [270, 480]})"},
    {"defects", paired, R"({"style": "defects"})"},
    {"tracks",
     [] {
       RodPicture picture = paired();
       DefectTrail plus{0.5, {}}, minus{-0.5, {}};
       for (int k = 0; k <= 20; ++k) {
         const double age = 1 - k / 20.0;
         plus.places.push_back({Vec2(12 - 14 * age, 19 + 3 * std::sin(6 * age)), age});  // from beyond the border
         minus.places.push_back({Vec2(26 + 4 * std::sin(9 * age), 19 - 8 * age), age});
       }
       picture.found.tracks = {plus, minus};
       return picture;
     },
     R"({"style": "defects", "caption": false, "legend": false, "scale_bar": false})"},
    {"director", paired, R"({"style": "director", "theme": "print"})"},
    {"bars", paired, R"({"rods": 0.3, "lines": "bars", "legend": false})"},
    {"tilt", layered, R"({"style": "tilt"})"},
    {"mechanism", layered, R"({"style": "mechanism"})"},
    {"orbit", layered, R"({"view": "orbit:-30,35", "colour": "tilt", "defects": false})"},
    {"orbit_of_a_disc", mixed, R"({"view": "orbit:40,20", "theme": "dark", "defects": false})"},
    {"mixture", mixed, R"({"style": "mixture"})"},
    {"heading", mixed, R"({"colour": "heading", "defects": false, "theme": "dark"})"},
    {"follow", paired, R"({"view": "follow:40", "defects": false})"},
    {"zoom_at_a_wall", mixed, R"({"zoom": 3, "focus": [0.1, 0.5], "defects": false})"},
    {"density", layered, R"({"colour": "density", "defects": false})"},
    {"whole", layered, R"({"whole": true, "colour": "id", "defects": false})"},
    {"order", paired, R"({"colour": "order"})"},
    {"panels",
     [] {
       RodPicture first = layered();
       first.captions.playback = 0.1;
       first.beside = {paired(), mixed()};
       first.beside[1].captions.label = "a mixture in a disc";
       first.beside[1].frame.time = first.frame.time;
       return first;
     },
     R"({"colour": "angle", "defects": true})"},
    {"inset_angles", layered, R"({"colour": "angle", "defects": false, "inset": "angles"})"},
    {"inset_order",
     [] {
       RodPicture first = layered(), second = paired();
       first.captions.history = {{0, 5, 12.34}, {0.2, 0.7, 0.9}, 0, 20};
       second.captions.history = {{0, 5, 12.34}, {0.2, 0.4, 0.3}, 0, 20};
       first.beside = {second};
       return first;
     },
     R"({"colour": "angle", "defects": false, "inset": "order", "size": [640, 360]})"},
    {"inset_sweep",
     [] {
       RodPicture picture = layered();
       SweepMap map{"\u03c6", "\u2113", {}};
       for (const double phi : {0.45, 0.6, 0.75}) {
         for (const double length : {2.5, 3.5, 4.5}) {
           const bool is_done = phi < 0.7 || length < 4;
           map.points.push_back({Vec2(phi, length), is_done ? phi * length / 4 : std::nan("")});
         }
       }
       picture.captions.sweep = std::make_shared<const SweepMap>(map);
       picture.captions.sweep_point = Vec2(0.75, 3.5);
       return picture;
     },
     R"({"colour": "layers", "defects": false, "inset": "sweep"})"},
    {"empty", [] { return empty_picture(20); }, R"({})"},
    {"no_shadows", one_large_rod,
     R"({"colour": "layers", "size": [160, 160], "legend": false, "caption": false, "shadows": false})"},
    {"no_gloss", one_large_rod,
     R"({"colour": "layers", "size": [160, 160], "legend": false, "caption": false, "gloss": false})"},
    {"no_occlusion", one_large_rod,
     R"({"colour": "layers", "size": [160, 160], "legend": false, "caption": false, "occlusion": false})"},
    {"no_smooth", one_large_rod,
     R"({"colour": "layers", "size": [160, 160], "legend": false, "caption": false, "smooth": false})"},
    {"one_rod_in_a_tiny_box",
     [] {
       RodPicture picture = empty_picture(2);
       add_rod(picture, 1, 1, 0.5);
       return picture;
     },
     R"({"colour": "layers"})"},
    {"crowd", [] { return lattice(60, 300, [](double x, double y) { return 0.02 * x + 0.5 * std::sin(0.05 * y); }); },
     R"({"size": [160, 160], "caption": false, "legend": false, "scale_bar": false, "defects": false})"},
};

/// Greatest mean difference over a square of 8 x 8 pixels, of one colour component.
double worst_patch(const Image& a, const Image& b) {
  double worst = 0;
  for (int y = 0; y + 8 <= a.height; y += 8) {
    for (int x = 0; x + 8 <= a.width; x += 8) {
      double sum = 0;
      for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 24; ++i) sum += std::abs(a.pixel(x, y + j)[i] - b.pixel(x, y + j)[i]);
      }
      worst = std::max(worst, sum / (8 * 24));
    }
  }
  return worst;
}

class Golden : public ::testing::TestWithParam<Case> {};

TEST_P(Golden, LooksAsItDid) {
  const Case& what = GetParam();
  PictureStyle small;
  small.width = 480;
  small.height = 270;
  auto style = load_style(what.style, what.name, small);
  ASSERT_TRUE(style) << to_string(style.error());
  if (std::string(what.name) == "mechanism") style->width = 480, style->height = 270;
  RodPicture picture = what.picture();
  measure(picture, asked_by(*style));
  for (RodPicture& other : picture.beside) measure(other, asked_by(*style));
  const Image image = painter().paint(picture, *style).value();
  const std::string file = kFolder + what.name + ".png";
  if (std::getenv("SHAKEN_UPDATE_DOCS") != nullptr) {
    ASSERT_TRUE(write_png(file, image));
    return;
  }
  const Image golden = read_png(file);
  ASSERT_EQ(image.width, golden.width);
  ASSERT_EQ(image.height, golden.height);
  const std::string mesa = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  if (mesa.find(kMesa) != std::string::npos && std::string(cairo_version_string()) == kCairo) {
    EXPECT_TRUE(image == golden) << "a pixel differs; worst patch " << worst_patch(image, golden);
  }
  // Other versions may shade and hint otherwise, but draw nothing elsewhere.
  EXPECT_LT(worst_patch(image, golden), 12);
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, ::testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace shaken::render
