#include "client/watch/cells.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace shaken::client {
namespace {

/// Scripts of which every character is one column wide on every terminal, without knowing its locale.
bool fills_one_column(char32_t glyph) {
  static constexpr std::pair<char32_t, char32_t> kNarrow[] = {
      {0x20, 0x7E},     {0xA1, 0xAC},     {0xAE, 0x2FF},    {0x370, 0x482},   {0x48A, 0x52F},   {0x2010, 0x2027},
      {0x2030, 0x205E}, {0x2070, 0x209F}, {0x20A0, 0x20BF}, {0x2100, 0x22FF}, {0x2500, 0x25FF}, {0x2800, 0x28FF}};
  return std::any_of(std::begin(kNarrow), std::end(kNarrow),
                     [glyph](const auto& range) { return glyph >= range.first && glyph <= range.second; });
}

/// The first character of `text`, which is cut off; U+FFFD where it is no UTF-8.
char32_t take_character(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t size = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
  char32_t glyph = size == 1 ? (lead < 0x80 ? lead : 0xFFFD) : lead & (0x7FU >> size);
  std::size_t i = 1;
  for (; i < size && i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; ++i) {
    glyph = glyph << 6 | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  text.remove_prefix(i);
  return i == size ? glyph : 0xFFFD;
}

/// Takes "\x1b[32m" and the like off the front of `text`, and does what they say to `style`.
void take_style(std::string_view& text, ScreenCell& style) {
  const std::size_t end = text.find('m');
  const std::string_view sequence = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (sequence.size() < 3 || sequence[1] != '[') return;
  int code = 0;
  std::from_chars(sequence.data() + 2, sequence.data() + sequence.size(), code);
  if (code == 0) style = ScreenCell{};
  if (code == 1) style.bold = true;
  if (code == 2) style.dim = true;
  if (code >= 30 && code <= 37) style.fore = theme_ink(code - 30);
}

}  // namespace

CellGrid::CellGrid(int columns, int lines)
    : columns_(std::max(columns, 0)),
      lines_(std::max(lines, 0)),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(lines_)) {}

int CellGrid::put(int column, int line, std::string_view text, int columns) {
  if (line < 0 || line >= lines_) return column;
  const int end = std::min(column + columns, columns_);
  ScreenCell style;
  while (!text.empty() && column < end) {
    if (text.front() == '\x1b') {
      take_style(text, style);
      continue;
    }
    style.glyph = take_character(text);
    if (!fills_one_column(style.glyph)) style.glyph = U'?';
    if (column >= 0) at(column, line) = style;
    ++column;
  }
  return column;
}

std::string CellGrid::text(int line) const {
  std::string text;
  for (int column = 0; column < columns_; ++column) append_utf8(text, at(column, line).glyph);
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

void append_utf8(std::string& text, char32_t glyph) {
  const auto piece = [&](char32_t bits) { text += static_cast<char>(bits); };
  if (glyph < 0x80) {
    piece(glyph);
  } else if (glyph < 0x800) {
    piece(0xC0 | glyph >> 6);
    piece(0x80 | (glyph & 0x3F));
  } else if (glyph < 0x10000) {
    piece(0xE0 | glyph >> 12);
    piece(0x80 | (glyph >> 6 & 0x3F));
    piece(0x80 | (glyph & 0x3F));
  } else {
    piece(0xF0 | glyph >> 18);
    piece(0x80 | (glyph >> 12 & 0x3F));
    piece(0x80 | (glyph >> 6 & 0x3F));
    piece(0x80 | (glyph & 0x3F));
  }
}

}  // namespace shaken::client
