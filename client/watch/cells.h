#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "client/live/rod_colours.h"

namespace shaken::client {

/// What stands in one place of a terminal.
struct ScreenCell {
  char32_t glyph = U' ';
  Ink fore = kOwnInk;
  Ink back = kOwnInk;
  bool bold = false;
  bool dim = false;
  friend bool operator==(const ScreenCell&, const ScreenCell&) = default;
};

/// A rectangle of cells.
struct Area {
  int column = 0;
  int line = 0;
  int columns = 0;
  int lines = 0;
  friend bool operator==(const Area&, const Area&) = default;
};

/// A whole screen.
class CellGrid {
 public:
  CellGrid(int columns, int lines);
  int columns() const { return columns_; }
  int lines() const { return lines_; }
  ScreenCell& at(int column, int line) { return cells_[index(column, line)]; }
  const ScreenCell& at(int column, int line) const { return cells_[index(column, line)]; }

  /// Writes UTF-8 `text` from (column, line) on, with the colours that Console::painted gives it, over at most
  /// `columns` columns; what does not fit in there or in the grid is left out. Characters that do not fill exactly one
  /// column become '?': they would shift all that follows. Returns the column behind the text.
  int put(int column, int line, std::string_view text, int columns);
  int put(int column, int line, std::string_view text) { return put(column, line, text, columns_ - column); }

  /// The characters of one line, in UTF-8, without the blanks at its end.
  std::string text(int line) const;

 private:
  std::size_t index(int column, int line) const { return static_cast<std::size_t>(line * columns_ + column); }

  int columns_;
  int lines_;
  std::vector<ScreenCell> cells_;
};

/// What each dot, by line and column, adds to the braille character without dots: Unicode numbers them 1-3 and 7 down
/// the left column, 4-6 and 8 down the right.
inline constexpr std::uint8_t kBrailleDots[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
inline constexpr char32_t kNoDots = 0x2800;

/// A character in UTF-8.
void append_utf8(std::string& text, char32_t glyph);

}  // namespace shaken::client
