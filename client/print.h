// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace shaken::client {

/// Columns that `text` fills on a terminal: one per character, none for colour sequences.
std::size_t display_width(std::string_view text);
/// `text`, cut to `width` columns with an ellipsis if it is longer; 0 stands for any width.
std::string fitted(std::string_view text, std::size_t width);

/// "0.4 s", "12 s", "3 min 20 s", "2 h 05 min", "3 d 04 h"; "?" for a negative, unknown or endless time.
std::string duration_text(double seconds);
/// The local time `seconds` from `now_utime` (microseconds since 1970): "14:32", or "Tue 14:32" on another day, or the
/// date beyond a week; "?" as in duration_text.
std::string clock_text(double seconds, std::int64_t now_utime);
/// Up to four significant digits: "0.9134", "2109", "1.2e+06".
std::string number_text(double value);
/// A bar of `width` columns, filled in steps of an eighth of a column.
std::string bar_text(double fraction, int width);
/// A field of a CSV file: quoted if need be (RFC 4180).
std::string csv_field(std::string_view text);

/// Rows of text in aligned columns.
class Table {
 public:
  enum class Align { kLeft, kRight };
  struct Column {
    std::string title;
    Align align = Align::kLeft;
    int rank = 0;  ///< where there is no room, the column with the highest rank goes first; 0: never
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// Needs as many cells as there are columns.
  void add_row(std::vector<std::string> cells);
  /// One line per row, titles first. Where `width` > 0 and a line does not fit, whole columns go by their rank; then
  /// texts (left-aligned, but for the first column) are shortened, the widest first and none below 4 characters.
  /// Numbers and names in the first column are never cut: what still does not fit is left to the terminal.
  std::string text(int width) const;
  /// Titles of the columns that text(width) leaves out.
  std::vector<std::string> left_out(int width) const;

 private:
  std::vector<std::size_t> widths() const;
  /// Whether each column is shown.
  std::vector<bool> shown(int width) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Microseconds since 1970.
std::int64_t now_utime();

}  // namespace shaken::client
