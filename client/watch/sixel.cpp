// SPDX-License-Identifier: MIT
#include "client/watch/sixel.h"

#include <sixel.h>

#include <memory>
#include <stdexcept>

namespace shaken::client {
namespace {

int append(char* bytes, int size, void* text) {
  static_cast<std::string*>(text)->append(bytes, static_cast<std::size_t>(size));
  return size;
}

void require(SIXELSTATUS status) {
  if (SIXEL_FAILED(status)) throw std::runtime_error("libsixel: " + std::string(sixel_helper_format_error(status)));
}

}  // namespace

std::string sixel_text(const RodImage& image) {
  std::string text;
  sixel_output_t* made_output = nullptr;
  require(sixel_output_new(&made_output, append, &text, nullptr));
  const std::unique_ptr<sixel_output_t, decltype(&sixel_output_unref)> output(made_output, sixel_output_unref);
  sixel_output_set_encode_policy(output.get(), SIXEL_ENCODEPOLICY_SIZE);

  // libsixel does not promise to leave what it is given as it is
  std::vector<std::uint8_t> colours(rod_palette().begin(), rod_palette().end());
  std::vector<std::uint8_t> pixels = image.pixels;
  sixel_dither_t* made_palette = nullptr;
  require(sixel_dither_new(&made_palette, kPaletteSize, nullptr));
  const std::unique_ptr<sixel_dither_t, decltype(&sixel_dither_unref)> palette(made_palette, sixel_dither_unref);
  sixel_dither_set_palette(palette.get(), colours.data());
  sixel_dither_set_pixelformat(palette.get(), SIXEL_PIXELFORMAT_PAL8);

  constexpr int kUnused = 0;
  require(sixel_encode(pixels.data(), image.size.width, image.size.height, kUnused, palette.get(), output.get()));
  return text;
}

}  // namespace shaken::client
