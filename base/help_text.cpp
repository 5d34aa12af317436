#include "base/help_text.h"

#include <algorithm>

#include "base/text.h"

namespace shaken {
namespace {

constexpr std::size_t kFarthestColumn = 40;  ///< of a description that stays beside what it describes
constexpr std::size_t kIndent = 30;          ///< of one that does not

/// The words of `text` in lines of `width` columns; the first begins at column `used`, the others at `indent`.
std::string in_lines(std::string_view text, std::size_t used, std::size_t indent, std::size_t width) {
  std::string lines;
  std::size_t column = used;
  bool is_first_word = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    const std::size_t columns = display_width(word);
    if (!is_first_word && column + 1 + columns > width) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!is_first_word) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += columns;
    is_first_word = false;
  }
  return lines;
}

std::string wrapped_line(std::string_view line, std::size_t width) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  if (indent == 0 || indent >= kIndent) {  // prose, or a description that has a line of its own
    return std::string(indent, ' ') + in_lines(line.substr(indent), indent, indent, width);
  }
  const std::size_t gap = line.find("  ", indent);
  if (gap == std::string_view::npos) return std::string(line);
  const std::size_t description = std::min(line.find_first_not_of(' ', gap), line.size());
  const std::string_view what = line.substr(0, gap);
  const std::size_t column = display_width(line.substr(0, description));
  if (column <= kFarthestColumn) {
    return std::string(line.substr(0, description)) + in_lines(line.substr(description), column, column, width);
  }
  const std::string indented = std::string(kIndent, ' ');
  return std::string(what) + "\n" + indented + in_lines(line.substr(description), kIndent, kIndent, width);
}

}  // namespace

std::string wrapped_help(std::string_view text, std::size_t width) {
  std::string wrapped;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    wrapped += display_width(line) <= width ? std::string(line) : wrapped_line(line, width);
    if (end < text.size()) wrapped += '\n';
    begin = end + 1;
  }
  return wrapped;
}

}  // namespace shaken
