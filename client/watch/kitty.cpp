// SPDX-License-Identifier: MIT
#include "client/watch/kitty.h"

#include <fmt/format.h>
#include <png.h>

#include <stdexcept>

#include "base/text.h"

namespace shaken::client {
namespace {

/// Names the image. Any number that others on the same terminal are unlikely to use.
constexpr int kImage = 0x5368616B;
constexpr std::size_t kMostInAPiece = 4096;

std::string png_bytes(const RodImage& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.size.width);
  png.height = static_cast<png_uint_32>(image.size.height);
  png.format = PNG_FORMAT_RGB_COLORMAP;
  png.flags = PNG_IMAGE_FLAG_FAST;
  png.colormap_entries = kPaletteSize;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, rod_palette().data()) == 0) {
    throw std::runtime_error("libpng: " + std::string(png.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string kitty_text(const RodImage& image) {
  const std::string data = base64(png_bytes(image));
  std::string text;
  for (std::size_t begin = 0; begin < data.size(); begin += kMostInAPiece) {
    const bool is_last = begin + kMostInAPiece >= data.size();
    // T: transmit and display; f=100: PNG; C=1: the cursor stays; q=2: no answers; m: more pieces follow.
    const std::string keys = begin == 0 ? fmt::format("a=T,f=100,i={},p=1,C=1,q=2,", kImage) : "";
    text += fmt::format("\x1b_G{}m={};", keys, is_last ? 0 : 1);
    text.append(data, begin, kMostInAPiece);
    text += "\x1b\\";
  }
  return text;
}

std::string kitty_removal() { return fmt::format("\x1b_Ga=d,d=I,i={},q=2\x1b\\", kImage); }

std::string kitty_query() { return fmt::format("\x1b_Gi={},s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\", kImage); }

}  // namespace shaken::client
