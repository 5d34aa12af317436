// SPDX-License-Identifier: MIT
#include "base/plot_origin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace shaken {
namespace {

/// The checksum of a PNG's chunks (PNG 1.2, 3.4).
std::uint32_t crc_of(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xEDB88320 ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>((value >> shift) & 0xFF);
  return bytes;
}

std::string text_chunk(const std::string& keyword, const std::string& text) {
  const bool is_ascii =
      std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  const std::string nul(1, '\0');
  // of iTXt: not compressed, no language, no translated keyword
  const std::string body = is_ascii ? "tEXt" + keyword + nul + text : "iTXt" + keyword + std::string(5, '\0') + text;
  return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(crc_of(body));
}

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : text) {
    switch (c) {
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '&':
        xml += "&amp;";
        break;
      default:
        xml += c;
    }
  }
  return xml;
}

}  // namespace

std::string as_comments(const PlotOrigin& origin) {
  std::string text;
  for (const auto& [keyword, line] : origin) text += fmt::format("# {}: {}\n", keyword, line);
  return text;
}

std::string png_with(std::string png, const PlotOrigin& origin) {
  constexpr std::size_t kHeader = 8 + 12 + 13;  // signature and IHDR
  if (png.size() < kHeader || !png.starts_with("\x89PNG\r\n\x1a\n")) return png;
  std::string chunks;
  for (const auto& [keyword, text] : origin) chunks += text_chunk(keyword, text);
  return png.insert(kHeader, chunks);
}

std::string svg_with(std::string svg, const PlotOrigin& origin) {
  constexpr std::string_view kBegin = "<desc>";
  const std::size_t at = svg.find(kBegin);
  if (at == std::string::npos) return svg;
  std::string text;
  for (const auto& [keyword, line] : origin) text += escaped(fmt::format("{}: {}\n", keyword, line));
  return svg.insert(at + kBegin.size(), text);
}

std::string origin_list(const std::vector<std::string>& names, std::size_t most) {
  if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(std::span(names).first(most), ", "), names.size() - most);
}

}  // namespace shaken
