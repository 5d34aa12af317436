#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace shaken::keys {

/// A line of a table of the pages, "| a | b |". A `|` in a cell, which would end it, is escaped.
inline std::string table_line(std::initializer_list<std::string_view> cells) {
  std::string line = "|";
  for (const std::string_view cell : cells) {
    line += ' ';
    for (const char c : cell) line += c == '|' ? std::string("\\|") : std::string(1, c);
    line += " |";
  }
  return line + "\n";
}

/// The titles of its columns, and the line below.
inline std::string table_head(std::initializer_list<std::string_view> titles) {
  std::string head = table_line(titles) + "|";
  for (std::size_t i = 0; i < titles.size(); ++i) head += "---|";
  return head + "\n";
}

}  // namespace shaken::keys
