// SPDX-License-Identifier: MIT
#pragma once

#include <png.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shaken::test {

/// What a terminal makes of an image: 0xRRGGBB for each pixel, line by line; -1 where nothing is painted.
struct TerminalImage {
  int width = 0;
  int height = 0;
  std::vector<int> pixels;
  int at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
};

/// Reads sixels (DEC STD 070, chapter 9), one pixel after the other, from "q" on to before the string's end. What is
/// outside of the size that is named first is an error.
inline TerminalImage read_sixels(std::string_view text) {
  std::size_t at = 0;
  const auto number = [&] {
    if (at >= text.size() || text[at] < '0' || text[at] > '9') throw std::runtime_error("no number in sixels");
    int value = 0;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') value = 10 * value + text[at++] - '0';
    return value;
  };
  const auto numbers = [&] {
    std::vector<int> all{number()};
    while (at < text.size() && text[at] == ';') {
      ++at;
      all.push_back(number());
    }
    return all;
  };
  TerminalImage image;
  std::map<int, int> registers;
  int colour = -1, x = 0, band = 0;
  const auto paint = [&](char sixel, int times) {
    if (sixel < '?' || sixel > '~') throw std::runtime_error("no sixel: " + std::string(1, sixel));
    for (int i = 0; i < times; ++i, ++x) {
      for (int k = 0; k < 6; ++k) {
        if (((sixel - '?') >> k & 1) == 0) continue;
        const int y = 6 * band + k;
        if (x >= image.width || y >= image.height || colour < 0) throw std::runtime_error("a sixel out of place");
        image.pixels[static_cast<std::size_t>(y * image.width + x)] = colour;
      }
    }
  };
  if (text.empty() || text[at++] != 'q') throw std::runtime_error("no sixels");
  while (at < text.size()) {
    const char c = text[at++];
    if (c == '"') {
      const std::vector<int> raster = numbers();
      image = {.width = raster.at(2), .height = raster.at(3), .pixels = {}};
      image.pixels.assign(static_cast<std::size_t>(image.width * image.height), -1);
    } else if (c == '#') {
      const std::vector<int> words = numbers();
      if (words.size() == 5) {
        const auto part = [&](std::size_t i) { return (words[i] * 255 + 50) / 100; };
        registers[words[0]] = part(2) << 16 | part(3) << 8 | part(4);
      }
      colour = registers.at(words[0]);
    } else if (c == '!') {
      const int times = number();
      paint(text.at(at), times);
      ++at;
    } else if (c == '$') {
      x = 0;
    } else if (c == '-') {
      x = 0;
      ++band;
    } else {
      paint(c, 1);
    }
  }
  return image;
}

inline std::string from_base64(std::string_view text) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits, bytes;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) throw std::runtime_error("no base64");
    for (int k = 5; k >= 0; --k) bits += (digit >> k & 1) != 0 ? '1' : '0';
  }
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8) {
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  }
  return bytes;
}

inline TerminalImage read_png(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) throw std::runtime_error(png.message);
  png.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> parts(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, parts.data(), 0, nullptr) == 0) throw std::runtime_error(png.message);
  TerminalImage image{.width = static_cast<int>(png.width), .height = static_cast<int>(png.height), .pixels = {}};
  for (std::size_t i = 0; i < parts.size(); i += 3) {
    image.pixels.push_back(parts[i] << 16 | parts[i + 1] << 8 | parts[i + 2]);
  }
  return image;
}

/// A terminal's side of kitty's graphics protocol, as far as PNG in pieces goes.
class KittyReader {
 public:
  /// What is between "\x1b_G" and "\x1b\\". Returns the keys of the command that it completes; none before.
  std::map<char, std::string> add(std::string_view command) {
    const std::size_t end = std::min(command.find(';'), command.size());
    const std::string_view payload = command.substr(std::min(end + 1, command.size()));
    std::map<char, std::string> keys;
    for (std::string_view rest = command.substr(0, end); !rest.empty();) {
      const std::string_view word = rest.substr(0, rest.find(','));
      if (word.size() < 3 || word[1] != '=') throw std::runtime_error("no key of kitty's: " + std::string(word));
      keys[word[0]] = word.substr(2);
      rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    }
    if (payload.size() > 4096) throw std::runtime_error("a piece of more than 4096 bytes");
    const bool is_more = keys.contains('m') && keys['m'] == "1";
    if (is_more && payload.size() % 4 != 0) throw std::runtime_error("a piece that ends within a group of base64");
    if (first_.empty()) first_ = keys;
    data_ += payload;
    if (is_more) return {};
    if (first_['f'] == "100") image_ = read_png(from_base64(data_));
    data_.clear();
    return std::exchange(first_, {});
  }
  /// The last one that came.
  const TerminalImage& image() const { return image_; }

 private:
  std::map<char, std::string> first_;
  std::string data_;
  TerminalImage image_;
};

}  // namespace shaken::test
