// SPDX-License-Identifier: MIT
#include "render/png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "tests/unit/render/support.h"

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

TEST(Png, RoundTrip) {
  const ScratchFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {640, 359}}) {
    const Image image = pattern(width, height);
    ASSERT_TRUE(write_png(folder / "a.png", image));
    EXPECT_EQ(read_png(folder / "a.png"), image);
  }
  EXPECT_EQ(folder.listing(), "a.png");
}

TEST(Png, TextsAreKept) {
  const ScratchFolder folder;
  RodPicture picture;
  picture.time = 12.5;
  picture.label = "\u03c6 = 0.80";
  picture.notes = {{"Run id", "1f0c"}};
  ASSERT_TRUE(write_png(folder / "a.png", pattern(8, 8), picture_texts(picture)));
  const std::map<std::string, std::string> expected = {
      {"Run id", "1f0c"}, {"Simulated time", "12.500000 s"}, {"Title", "\u03c6 = 0.80"}};
  EXPECT_EQ(texts_of(folder / "a.png"), expected);
}

TEST(Png, AFolderThatDoesNotExistIsAnError) {
  const auto done = write_png("/nowhere/at/all/a.png", pattern(8, 8));
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("/nowhere/at/all/a.png: No such file"), std::string::npos)
      << done.error().message;
}

TEST(Png, ANameThatCannotBeTakenLeavesNothingBehind) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "a.png/full");
  const auto done = write_png(folder / "a.png", pattern(8, 8));
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("a.png"), std::string::npos);
  EXPECT_EQ(folder.listing(), "a.png");
}

TEST(Png, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const ScratchFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "a.png.tmp");
  ASSERT_FALSE(write_png(folder / "a.png", pattern(300, 300)));
  EXPECT_EQ(folder.listing(), "");
}

}  // namespace
}  // namespace shaken::render
