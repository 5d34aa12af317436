#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "client/watch/cells.h"

namespace shaken::test {

/// As much of a terminal as `shaken watch` needs: it obeys what is written to it (ECMA-48), and remembers what it did
/// not understand.
class SmallTerminal {
 public:
  using ScreenCell = client::ScreenCell;
  SmallTerminal(int columns, int lines)
      : columns_(columns), lines_(lines), cells_(static_cast<std::size_t>(columns * lines)) {}

  void write(std::string_view bytes) {
    rest_ += bytes;
    while (!rest_.empty()) {
      const std::size_t size = rest_.front() == '\x1b' ? take_sequence() : take_character();
      if (size == 0) return;
      rest_.erase(0, size);
    }
  }
  /// Forgets what is shown, as terminals may.
  void resize(int columns, int lines) {
    columns_ = columns;
    lines_ = lines;
    cells_.assign(static_cast<std::size_t>(columns * lines), {});
  }

  const ScreenCell& at(int column, int line) const {
    return cells_[static_cast<std::size_t>(line * columns_ + column)];
  }
  /// All lines, without blanks at their ends.
  std::string text() const {
    std::string all;
    for (int line = 0; line < lines_; ++line) {
      std::string text;
      for (int column = 0; column < columns_; ++column) append(text, at(column, line).glyph);
      text.erase(text.find_last_not_of(' ') + 1);
      all += text + "\n";
    }
    return all;
  }
  bool is_on_second_page() const { return second_page_; }
  /// How often the second page was gone to.
  int n_visits() const { return n_visits_; }
  bool shows_cursor() const { return cursor_; }
  bool is_updating() const { return updating_; }
  const std::string& misunderstood() const { return misunderstood_; }

 private:
  static void append(std::string& text, char32_t glyph) {
    if (glyph < 0x80) {
      text += static_cast<char>(glyph);
    } else if (glyph < 0x800) {
      text += {static_cast<char>(0xC0 | glyph >> 6), static_cast<char>(0x80 | (glyph & 0x3F))};
    } else {
      text += {static_cast<char>(0xE0 | glyph >> 12), static_cast<char>(0x80 | (glyph >> 6 & 0x3F)),
               static_cast<char>(0x80 | (glyph & 0x3F))};
    }
  }

  std::size_t take_character() {
    const auto lead = static_cast<unsigned char>(rest_.front());
    const std::size_t size = lead < 0x80 ? 1 : lead >= 0xE0 ? 3 : 2;
    if (rest_.size() < size) return 0;
    if (lead == '\r') {
      column_ = 0;
    } else if (lead == '\n') {
      line_ = std::min(line_ + 1, lines_ - 1);
    } else if (lead < 0x20) {
      misunderstood_ += rest_.front();
    } else {
      char32_t glyph = size == 1 ? lead : lead & (0x7FU >> size);
      for (std::size_t i = 1; i < size; ++i) glyph = glyph << 6 | (static_cast<unsigned char>(rest_[i]) & 0x3FU);
      ScreenCell cell = style_;
      cell.glyph = glyph;
      if (column_ < columns_) cells_[static_cast<std::size_t>(line_ * columns_ + column_++)] = cell;
    }
    return size;
  }

  std::size_t take_sequence() {
    const std::size_t end = rest_.find_first_of("ABCDEFGHJKmhlsutc", 2);
    if (rest_.size() < 3 || end == std::string::npos) return 0;
    const std::string body = rest_.substr(2, end - 2);
    std::vector<int> numbers;
    std::string number;
    for (const char c : body + ";") {
      if (c == ';') {
        numbers.push_back(number.empty() ? 0 : std::stoi(number));
        number.clear();
      } else if (c != '?') {
        number += c;
      }
    }
    obey(rest_[end], body, numbers);
    return end + 1;
  }

  void obey(char command, const std::string& body, const std::vector<int>& numbers) {
    if (command == 'H') {
      line_ = std::clamp(numbers[0], 1, lines_) - 1;
      column_ = std::clamp(numbers.size() > 1 ? numbers[1] : 1, 1, columns_) - 1;
    } else if (command == 'C') {
      column_ = std::min(column_ + std::max(numbers[0], 1), columns_ - 1);
    } else if (command == 'J' && numbers[0] == 2) {
      cells_.assign(cells_.size(), {});
    } else if (command == 'm') {
      restyle(numbers);
    } else if (body == "?1049") {
      second_page_ = command == 'h';
      n_visits_ += second_page_ ? 1 : 0;
      // What stood on the first page is not kept; its cursor is at the beginning.
      cells_.assign(cells_.size(), {});
      line_ = column_ = 0;
    } else if (body == "?25") {
      cursor_ = command == 'h';
    } else if (body == "?2026") {
      updating_ = command == 'h';
    } else {
      misunderstood_ += body + command;
    }
  }

  void restyle(const std::vector<int>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const int n = numbers[i];
      client::Ink& ink = n >= 40 && n < 50 ? style_.back : style_.fore;
      if (n == 0) {
        style_ = {};
      } else if (n == 1) {
        style_.bold = true;
      } else if (n == 2) {
        style_.dim = true;
      } else if (n == 39 || n == 49) {
        ink = client::kOwnInk;
      } else if ((n == 38 || n == 48) && i + 4 < numbers.size() && numbers[i + 1] == 2) {
        ink = numbers[i + 2] << 16 | numbers[i + 3] << 8 | numbers[i + 4];
        i += 4;
      } else if ((n >= 30 && n < 38) || (n >= 40 && n < 48)) {
        ink = client::theme_ink(n % 10);
      } else {
        misunderstood_ += std::to_string(n) + "m";
      }
    }
  }

  int columns_;
  int lines_;
  int column_ = 0;
  int line_ = 0;
  ScreenCell style_;
  std::vector<ScreenCell> cells_;
  bool second_page_ = false;
  int n_visits_ = 0;
  bool cursor_ = true;
  bool updating_ = false;
  std::string rest_;
  std::string misunderstood_;
};

}  // namespace shaken::test
