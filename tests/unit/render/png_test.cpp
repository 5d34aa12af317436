#include "render/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>

#include "tests/support/good.h"
#include "tests/support/in_child.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

Image pattern(int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint8_t>(i * i / 7 + 31 * i);
  return image;
}

std::map<std::string, std::string> texts_of(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_info(png, info);
  png_textp texts = nullptr;
  const int n = png_get_text(png, info, &texts, nullptr);
  std::map<std::string, std::string> all;
  for (int i = 0; i < n; ++i) all[texts[i].key] = texts[i].text;
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return all;
}

TEST(Png, SaysHowManyPixelsAnInchHas) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", Image(3, 2), {}, 300));
  ASSERT_TRUE(write_png(folder / "b.png", Image(3, 2)));
  const auto chunk = [&](const char* name) {
    std::ifstream file(folder / name, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::size_t at = bytes.find("pHYs");
    return at == std::string::npos ? std::string() : bytes.substr(at + 4, 9);
  };
  // 300 / 0.0254 = 11811 = 0x2e23 pixels per metre each way, unit 1.
  EXPECT_EQ(chunk("a.png"), std::string("\0\0\x2e\x23\0\0\x2e\x23\1", 9));
  EXPECT_EQ(chunk("b.png"), "");
}

TEST(Png, RoundTrip) {
  const ScratchFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {640, 359}}) {
    const Image image = pattern(width, height);
    ASSERT_TRUE(write_png(folder / "a.png", image));
    EXPECT_EQ(read_png(folder / "a.png"), image);
  }
  EXPECT_EQ(listing(folder), "a.png");
}

/// Its colours as numbers; empty if it has not 16 bits a colour.
DeepImage read_deep(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  DeepImage image;
  if (png_get_bit_depth(png, info) == 16) {
    image =
        DeepImage(static_cast<int>(png_get_image_width(png, info)), static_cast<int>(png_get_image_height(png, info)));
    for (int y = 0; y < image.height; ++y) {
      const png_bytep row = png_get_rows(png, info)[y];
      for (int i = 0; i < 3 * image.width; ++i) {
        image.pixel(0, y)[i] = static_cast<std::uint16_t>(row[2 * i] << 8 | row[2 * i + 1]);
      }
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return image;
}

TEST(Png, SixteenBitsComeBackAsTheyWere) {
  const ScratchFolder folder;
  DeepImage image(31, 17);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint16_t>(i * i * 41 + 7 * i);
  ASSERT_TRUE(write_png(folder / "a.png", image, {{"Run id", "1f0c"}}));
  EXPECT_EQ(read_deep(folder / "a.png"), image);
  EXPECT_EQ(texts_of(folder / "a.png").at("Run id"), "1f0c");
  ASSERT_TRUE(write_png(folder / "b.png", pattern(8, 8)));
  EXPECT_EQ(read_deep(folder / "b.png").width, 0) << "the other ones have 8";
}

TEST(Png, APictureOf16BitsIsThatOf8WithMoreShades) {
  RodPicture picture = empty_picture(30);
  for (int i = 0; i < 60; ++i) add_rod(picture, 5 * (i % 6) + 2, 3 * (i / 6) + 1, 0.1 * i, 0.1);
  picture.frame.velocity.assign(picture.n_rods(), Vec3(1, 2, 0));
  picture.captions.label = "words";
  picture.found.defects = {{Vec2(10, 10), 0.5, 1}};
  RodPicture both = picture;
  both.beside = {picture};
  for (const char* look : {"top", "pale", "gap", "panels"}) {
    const std::string what = look;
    PictureStyle style;
    style.width = 640;
    style.height = 360;
    if (what == "gap") style.view = ViewPoint::kGap;
    if (what == "pale") style.rods = 0.4;
    const RodPicture& drawn = what == "panels" ? both : picture;
    const Image flat = painter().paint(drawn, style).value();
    const DeepImage deep = painter().paint<std::uint16_t>(drawn, style).value();
    ASSERT_EQ(deep.rgb.size(), flat.rgb.size());
    double worst = 0;
    std::size_t between = 0;
    for (std::size_t i = 0; i < flat.rgb.size(); ++i) {
      worst = std::max(worst, std::abs(deep.rgb[i] / 257.0 - flat.rgb[i]));
      between += deep.rgb[i] % 257 != 0 ? 1 : 0;
    }
    EXPECT_LE(worst, 2) << what << ": of 255";
    EXPECT_GT(between, flat.rgb.size() / 20) << what << ": shades that 8 bits do not have";
    EXPECT_EQ(painter().paint<std::uint16_t>(drawn, style).value(), deep) << what;
  }
}

TEST(Png, TextsAreKept) {
  const ScratchFolder folder;
  RodPicture picture;
  picture.frame.time = 12.5;
  picture.captions.label = "\u03c6 = 0.80";
  picture.captions.notes = {{"Run id", "1f0c"}};
  ASSERT_TRUE(write_png(folder / "a.png", pattern(8, 8), picture_texts(picture.frame, picture.captions)));
  const std::map<std::string, std::string> expected = {
      {"Run id", "1f0c"}, {"Simulated time", "12.500000 s"}, {"Title", "\u03c6 = 0.80"}};
  EXPECT_EQ(texts_of(folder / "a.png"), expected);
}

TEST(Png, AFolderThatDoesNotExistIsAnError) {
  EXPECT_THAT(test::refusal(write_png("/nowhere/at/all/a.png", pattern(8, 8))),
              testing::HasSubstr("/nowhere/at/all/a.png: No such file"));
}

TEST(Png, ANameThatCannotBeTakenLeavesNothingBehind) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "a.png/full");
  EXPECT_THAT(test::refusal(write_png(folder / "a.png", pattern(8, 8))), testing::HasSubstr("a.png"));
  EXPECT_EQ(listing(folder), "a.png");
}

TEST(Png, AFullDiskIsAnError) {
  const ScratchFolder folder;
  const int failures = in_child([&] {
    limit_file_size(1000);
    const auto done = write_png(folder / "a.png", pattern(300, 300));
    return !done && done.error().message.find("File too large") != std::string::npos;
  });
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(listing(folder), "");
}

}  // namespace
}  // namespace shaken::render
