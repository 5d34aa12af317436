#include "render/plane_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "render/canvas.h"
#include "render/colours.h"
#include "render/picture_layout.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace plane_layers_test {

constexpr double kBox = 60;
constexpr int kSide = 720;
const Vec2 kPlus(20, 30), kMinus(40, 30);

/// Director theta = (angle about kPlus - angle about kMinus) / 2 + `turn`: +1/2 at kPlus, -1/2 at kMinus.
RodPicture planted_pair(double turn) {
  RodPicture picture = empty_picture(kBox);
  for (double x = 0.5; x < kBox; x += 1) {
    for (double y = 0.5; y < kBox; y += 1) {
      const Vec2 p = Vec2(x, y) - kPlus, m = Vec2(x, y) - kMinus;
      add_rod(picture, x, y, 0.5 * (std::atan2(p.y(), p.x()) - std::atan2(m.y(), m.x())) + turn);
    }
  }
  return picture;
}

PictureStyle bare(const char* name = "") {
  PictureStyle style;
  style.width = style.height = kSide;
  style.caption = style.legend = style.scale_bar = false;
  if (std::string(name) == "director") {
    style.rods = 0;
    style.background = Background::kOrder;
    style.lines = FieldLines::kStreamlines;
  }
  if (std::string(name) == "defects") {
    style.rods = 0.6;
    style.background = Background::kOrder;
  }
  return style;
}

int grey_at(const Image& image, const Vec2& place) {
  const int x = static_cast<int>(place.x() / kBox * kSide), y = static_cast<int>(kSide - place.y() / kBox * kSide);
  const std::uint8_t* p = image.pixel(x, y);
  return (p[0] + p[1] + p[2]) / 3;
}

Vec2 along(double angle) { return {std::cos(angle), std::sin(angle)}; }

TEST(PlantedPair, IsDrawnWhereAndAsItIsInEveryStyle) {
  for (const double turn : {0.0, 0.7, -1.1}) {
    RodPicture picture = planted_pair(turn);
    measure(picture, {.defects = true, .field = true});
    ASSERT_EQ(picture.found.defects.size(), 2u);
    // Near the +1/2 theta = phi / 2 + (turn - pi / 2): radial where phi = 2 turn - pi. Near the -1/2
    // theta = -phi / 2 + turn: radial where phi = 2 turn / 3, and 120 degrees on.
    const double tail = 2 * turn - kPi, arm = 2 * turn / 3;
    const double mm = kBox / kSide;  // of a pixel, which is a unit here
    for (const char* name : {"", "defects", "director"}) {
      const Image image = painter().paint(picture, bare(name)).value();
      const auto shade = [&](const Vec2& core, double pixels, double angle) {
        return grey_at(image, core + pixels * mm * along(angle));
      };
      // What it is drawn at is where it is found, to within a millimetre of where it was planted.
      const auto found = [&](double charge) {
        return std::find_if(picture.found.defects.begin(), picture.found.defects.end(),
                            [&](const analysis::Defect& d) { return d.charge == charge; })
            ->position;
      };
      ASSERT_LT((found(0.5) - kPlus).norm(), 1);
      ASSERT_LT((found(-0.5) - kMinus).norm(), 1);
      EXPECT_GT(shade(found(0.5), 0, 0), 240) << name << ": the comet's core";
      EXPECT_LT(shade(found(0.5), 23, tail), 60) << name << ": its tail";
      EXPECT_GT(shade(found(0.5), 23, tail + kPi), 60) << name << ": none to the other side";
      EXPECT_LT(shade(found(0.5), 5.5, tail + kPi), 60) << name << ": its head";
      for (int k = 0; k < 3; ++k) {
        EXPECT_GT(shade(found(-0.5), 13, arm + k * 2 * kPi / 3), 240) << name << ": arm " << k;
        EXPECT_LT(shade(found(-0.5), 5.9, arm + (k + 0.5) * 2 * kPi / 3), 130) << name << ": rim between arms " << k;
      }
    }
  }
}

TEST(Streamlines, FollowTheDirectorAndCoverTheField) {
  RodPicture picture = planted_pair(0.4);
  measure(picture, {.field = true});
  const double distance = 1.5;
  const std::vector<Streamline> lines = streamlines(*picture.found.field, distance);
  ASSERT_GT(lines.size(), 20u);
  double length = 0;
  for (const Streamline& line : lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Vec2 step = line[k + 1] - line[k], middle = (line[k] + line[k + 1]) / 2;
      length += step.norm();
      if ((middle - kPlus).norm() < 3 || (middle - kMinus).norm() < 3) continue;  // there the field bends sharply
      const Vec2 q = picture.found.field->q_at(middle);
      const double theta = std::atan2(q.y(), q.x()) / 2;
      EXPECT_GT(std::abs(step.normalized().dot(along(theta))), 0.99);
    }
  }
  // Lines a distance apart have a length of area / distance; they may come as near as half of it.
  EXPECT_GT(length, 0.8 * kBox * kBox / distance);
  EXPECT_LT(length, 2.0 * kBox * kBox / distance);
}

TEST(Streamlines, KeepTheirDistance) {
  RodPicture picture = planted_pair(0);
  measure(picture, {.field = true});
  const double distance = 2;
  const std::vector<Streamline> lines = streamlines(*picture.found.field, distance);
  for (std::size_t a = 0; a < lines.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      for (const Vec2& p : lines[a]) {
        for (const Vec2& q : lines[b]) {
          const Vec2 d(std::remainder(p.x() - q.x(), kBox), std::remainder(p.y() - q.y(), kBox));
          ASSERT_GT(d.norm(), distance / 2 - 1e-9);
        }
      }
    }
  }
}

TEST(Streamlines, AUniformFieldGivesStraightLines) {
  RodPicture picture = empty_picture(20);
  for (int i = 0; i < 400; ++i) add_rod(picture, i % 20 + 0.5, i / 20 + 0.5, 0);
  measure(picture, {.field = true});
  for (const Streamline& line : streamlines(*picture.found.field, 1)) {
    for (const Vec2& point : line) ASSERT_NEAR(point.y(), line.front().y(), 1e-6);
  }
}

// Rod 0 has come 8 mm to the right, over the border at x = 0 = side; rod 1 has not moved.
TEST(Displacements, AreArrowsOfTrueLengthToTheRods) {
  RodPicture picture = empty_picture(kBox);
  add_rod(picture, 4, kBox / 2, kPi / 2);
  add_rod(picture, 20, 10, kPi / 2);
  picture.frame.displacement = {Vec2(8, 0), Vec2(0, 0)};
  PictureStyle style = bare();
  style.rods = 0;
  const Image image = painter().paint(picture, style).value();
  // a line is one or two pixels wide
  const auto is_dark = [&](double x, double y) {
    const int i = static_cast<int>(x / kBox * kSide), j = static_cast<int>((1 - y / kBox) * kSide);
    const auto brightness = [&](int row) {
      return image.pixel(i, row)[0] + image.pixel(i, row)[1] + image.pixel(i, row)[2];
    };
    return std::min({brightness(j - 1), brightness(j), brightness(j + 1)}) < 450;
  };
  EXPECT_TRUE(is_dark(1, kBox / 2)) << "within the box";
  EXPECT_TRUE(is_dark(kBox - 3, kBox / 2)) << "beyond the border";
  EXPECT_FALSE(is_dark(kBox - 5, kBox / 2)) << "it began at " << kBox - 4;
  EXPECT_FALSE(is_dark(5, kBox / 2)) << "it ends at 4";
  EXPECT_FALSE(is_dark(20, 10)) << "what has not moved has no arrow";
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(VectorFigure, IsASvgOrAPdf) {
  const ScratchFolder folder;
  RodPicture picture = planted_pair(0.2);
  picture.captions.label = "a <pair> & more";
  picture.captions.notes = {{"Run id", "1f0c"}, {"Seed", "7"}};
  measure(picture, {.defects = true, .field = true});
  PictureStyle style = bare("director");
  for (const char* name : {"a.svg", "a.pdf", "b.pdf"}) ASSERT_TRUE(write_vector(folder / name, picture, style));
  EXPECT_EQ(listing(folder), "a.pdf a.svg b.pdf");
  EXPECT_EQ(bytes_of(folder / "a.pdf").substr(0, 5), "%PDF-");
  EXPECT_TRUE(bytes_of(folder / "a.pdf") == bytes_of(folder / "b.pdf")) << "not a word of when it was written";
  const std::string svg = bytes_of(folder / "a.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("<title>a &lt;pair&gt; &amp; more</title>\n<desc>Run id: 1f0c; Seed: 7</desc>"),
            std::string::npos);
  // Without rods there are the lines alone; with them an outline for each, and for each image across the border.
  const auto paths = [&](const std::string& text) {
    std::size_t n = 0;
    for (auto at = text.find("<path"); at != std::string::npos; at = text.find("<path", at + 1)) ++n;
    return n;
  };
  style.rods = 0.5;
  ASSERT_TRUE(write_vector(folder / "a.svg", picture, style));
  EXPECT_GT(paths(bytes_of(folder / "a.svg")), paths(svg) + picture.n_rods());
}

// What is written can be searched, and changed in a drawing program.
TEST(VectorFigure, TextIsTextInAnSvg) {
  const ScratchFolder folder;
  RodPicture picture = planted_pair(0.2);
  picture.captions.label = "\u03c6 < 0.8";
  measure(picture, {});
  ASSERT_TRUE(write_vector(folder / "a.svg", picture, {}));
  const std::string svg = bytes_of(folder / "a.svg");
  EXPECT_NE(svg.find("font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\""), std::string::npos);
  EXPECT_NE(svg.find(">\u03c6 &lt; 0.8</text>"), std::string::npos);
  EXPECT_EQ(svg.find("glyph"), std::string::npos) << "no outlines of letters";
  EXPECT_LT(svg.find("<path"), svg.find("<text")) << "over everything";
}

TEST(VectorFigure, WithoutGroundHasNoPageAndNoFloor) {
  const ScratchFolder folder;
  const auto areas = [&](bool transparent) {
    PictureStyle style = bare();
    style.transparent = transparent;
    EXPECT_TRUE(write_vector(folder / "a.svg", empty_picture(10), style));
    const std::string svg = bytes_of(folder / "a.svg");
    std::size_t n = 0;
    for (auto at = svg.find("fill:rgb"); at != std::string::npos; at = svg.find("fill:rgb", at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(areas(false), 2u);
  EXPECT_EQ(areas(true), 0u);
}

// Laid over a colour, it is the picture that has this colour as its ground.
TEST(ClearPicture, LaidOverAColourIsThePictureOnIt) {
  RodPicture picture = empty_picture(10);
  for (const double y : {2.0, 4.0, 6.0}) add_rod(picture, 5, y, 0.1 * y);
  measure(picture, {});
  PictureStyle style = bare();
  const ClearImage clear = painter().paint_clear(picture, style).value();
  const Colour grey{0.5, 0.4, 0.6};
  style.ground = grey;
  const Image on_grey = painter().paint(picture, style).value();
  ASSERT_EQ(clear.rgba.size(), on_grey.rgb.size() / 3 * 4);
  double worst = 0;
  std::size_t n_clear = 0, n_full = 0;
  for (std::size_t i = 0; i < on_grey.rgb.size() / 3; ++i) {
    const double opacity = clear.rgba[4 * i + 3] / 255.0;
    n_clear += opacity == 0 ? 1 : 0;
    n_full += opacity == 1 ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double laid = opacity * clear.rgba[4 * i + c] + (1 - opacity) * 255 * grey[c];
      worst = std::max(worst, std::abs(laid - on_grey.rgb[3 * i + c]));
    }
  }
  EXPECT_LT(worst, 3);
  EXPECT_GT(n_clear, clear.rgba.size() / 4 / 2);
  EXPECT_GT(n_full, clear.rgba.size() / 4 / 20) << "rods are not";
}

TEST(VectorFigure, AFolderThatDoesNotExistIsAnError) {
  const auto done = write_vector("/nowhere/at/all/a.svg", empty_picture(10), bare());
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("/nowhere/at/all/a.svg"), std::string::npos);
}

/// The rods of a picture as write_vector() draws them, on pixels.
Image flat_image(const RodPicture& picture, const PictureStyle& style) {
  Canvas canvas(style.width, style.height, page_colours(style.theme).page);
  const Layout layout = layout_of(style, {});
  draw_ground(canvas, layout, picture, style);
  draw_flat_rods(canvas, layout, picture, style);
  return canvas.image();
}

TEST(FlatRods, HaveTheOutlineThatTheRasterisedOnesHave) {
  // Level, tilted and upright rods, a sphere whose director says nothing, a polar rod.
  RodPicture picture = empty_picture(20);
  picture.cell.shapes.push_back({{0}, {0.9}});
  picture.cell.shapes.push_back({{-1, 0, 1}, {0.9, 0.5, 0.2}});
  for (const double n_z : {0.0, 0.3, 0.7, 0.95, 1.0}) {
    for (const std::uint8_t species : {0, 1, 2}) {
      add_rod(picture, 2 + 15 * n_z, 3.0 + 6 * species, 0.4, n_z);
      picture.cell.shape_of_rod.push_back(species);
    }
  }
  PictureStyle style = bare();
  style.colour = "species";
  style.mark_defects = false;
  style.light.shadows = false;
  const Image flat = flat_image(picture, style), round = painter().paint(picture, style).value();
  const Colour floor = page_colours(style.theme).floor;
  const auto is_rod = [&](const std::uint8_t* p) {
    return std::abs(p[0] - 255 * floor[0]) + std::abs(p[1] - 255 * floor[1]) + std::abs(p[2] - 255 * floor[2]) > 40;
  };
  int rods = 0, differ = 0;
  for (int y = 3; y < kSide - 3; ++y) {
    for (int x = 3; x < kSide - 3; ++x) {
      const bool is = is_rod(round.pixel(x, y));
      rods += is;
      if (is == is_rod(flat.pixel(x, y))) continue;
      // Their edges may lie a pixel apart: the flat ones have a line around them.
      bool is_edge = false;
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) is_edge = is_edge || is_rod(round.pixel(x + dx, y + dy)) != is;
      }
      differ += !is_edge;
    }
  }
  EXPECT_GT(rods, 10000);
  EXPECT_LT(differ, 0.001 * rods) << "but where two round beads meet";
}

}  // namespace plane_layers_test
}  // namespace shaken::render
