#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace shaken {

using Row = std::vector<std::string>;  ///< the cells of one line

/// Rows of text in aligned columns.
class Table {
 public:
  enum class Align { kLeft, kRight };
  struct Column {
    std::string title;
    Align align = Align::kLeft;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// Needs as many cells as there are columns.
  void add_row(Row cells);
  /// One line per row, titles first. Where `width` > 0 and a line does not fit, texts (left-aligned, but for the first
  /// column) are shortened, the widest first and none below 4 characters. Numbers and names in the first column are
  /// never cut: what still does not fit is left to the terminal.
  std::string text(int width) const;

 private:
  std::vector<std::size_t> widths() const;

  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace shaken
