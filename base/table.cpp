#include "base/table.h"

#include <algorithm>
#include <optional>

#include "base/text.h"

namespace shaken {
namespace {

/// Between the columns of a table, and what a shortened one keeps at least.
constexpr std::size_t kGap = 2;
constexpr std::size_t kNarrowest = 4;

}  // namespace

void Table::add_row(Row cells) {
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> Table::widths() const {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    std::size_t widest = display_width(columns_[c].title);
    for (const auto& row : rows_) widest = std::max(widest, display_width(row[c]));
    widths.push_back(widest);
  }
  return widths;
}

std::string Table::text(int width) const {
  std::vector<std::size_t> widths = this->widths();
  const auto total = [&] {
    std::size_t sum = 0;
    for (const std::size_t each : widths) sum += each + (sum > 0 ? kGap : 0);
    return sum;
  };
  while (width > 0 && total() > static_cast<std::size_t>(width)) {
    std::optional<std::size_t> widest;
    for (std::size_t c = 1; c < widths.size(); ++c) {
      const bool may_be_cut = columns_[c].align == Align::kLeft && widths[c] > kNarrowest;
      if (may_be_cut && (!widest || widths[c] > widths[*widest])) widest = c;
    }
    if (!widest) break;
    --widths[*widest];
  }

  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string cell = fitted(cells[c], widths[c]);
      const std::string padding(widths[c] - std::min(widths[c], display_width(cell)), ' ');
      if (!line.empty()) line.append(kGap, ' ');
      line += columns_[c].align == Align::kRight ? padding + cell : cell + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  std::vector<std::string> titles;
  for (const Column& column : columns_) titles.push_back(column.title);
  add_line(titles);
  for (const auto& row : rows_) add_line(row);
  return text;
}

}  // namespace shaken
