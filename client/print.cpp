// SPDX-License-Identifier: MIT
#include "client/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>

namespace shaken::client {
namespace {

/// Calls visit(piece, columns) for each character (columns 1) and each colour sequence (columns 0) of UTF-8 `text`.
template <class Visit>
void for_each_character(std::string_view text, Visit visit) {
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin + 1;
    const bool is_escape = text[begin] == '\x1b';
    if (is_escape) {
      while (end < text.size() && text[end - 1] != 'm') ++end;
    } else {
      while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
    }
    if (!visit(text.substr(begin, end - begin), is_escape ? std::size_t{0} : std::size_t{1})) return;
    begin = end;
  }
}

/// Between the columns of a table, and what a shortened one keeps at least.
constexpr std::size_t kGap = 2;
constexpr std::size_t kNarrowest = 4;

bool is_unknown(double seconds) { return !(seconds >= 0.0) || seconds > 1e10; }

}  // namespace

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  for_each_character(text, [&](std::string_view, std::size_t columns) {
    width += columns;
    return true;
  });
  return width;
}

std::string fitted(std::string_view text, std::size_t width) {
  if (width == 0 || display_width(text) <= width) return std::string(text);
  std::string cut;
  std::size_t used = 0;
  bool coloured = false;
  for_each_character(text, [&](std::string_view piece, std::size_t columns) {
    if (used + columns > width - 1) return false;
    used += columns;
    coloured = coloured || columns == 0;
    cut += piece;
    return true;
  });
  return cut + "…" + (coloured ? "\x1b[0m" : "");
}

std::string duration_text(double seconds) {
  if (is_unknown(seconds)) return "?";
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const auto s = static_cast<std::int64_t>(std::llround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  const std::int64_t minutes = (s + 30) / 60;
  if (minutes < std::int64_t{24} * 60) return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
  const std::int64_t hours = (s + 1800) / 3600;
  return fmt::format("{} d {:02} h", hours / 24, hours % 24);
}

std::string clock_text(double seconds, std::int64_t now) {
  if (is_unknown(seconds)) return "?";
  const auto now_s = static_cast<std::time_t>(now / 1'000'000);
  const std::time_t then_s = now_s + static_cast<std::time_t>(std::llround(seconds));
  std::tm today{};
  std::tm then{};
  localtime_r(&now_s, &today);
  localtime_r(&then_s, &then);
  const bool same_day = today.tm_yday == then.tm_yday && today.tm_year == then.tm_year;
  char text[32];
  std::strftime(text, sizeof text, same_day ? "%H:%M" : (seconds < 6 * 86400 ? "%a %H:%M" : "%Y-%m-%d"), &then);
  return text;
}

std::string number_text(double value) {
  if (std::isnan(value)) return "-";
  // Whole numbers are counts: every digit matters.
  if (value == std::floor(value) && std::abs(value) < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

std::string bar_text(double fraction, int width) {
  static constexpr const char* kEighths[] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const double clamped = std::isnan(fraction) ? 0.0 : std::clamp(fraction, 0.0, 1.0);
  const int eighths = static_cast<int>(std::floor(clamped * width * 8 + 1e-9));
  std::string bar;
  for (int i = 0; i < eighths / 8; ++i) bar += "█";
  int used = eighths / 8;
  if (eighths % 8 != 0) {
    bar += kEighths[eighths % 8];
    ++used;
  }
  for (; used < width; ++used) bar += "·";
  return bar;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void Table::add_row(std::vector<std::string> cells) {
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

std::vector<bool> Table::shown(int width) const {
  std::vector<bool> shown(columns_.size(), true);
  if (width <= 0) return shown;
  const std::vector<std::size_t> all = widths();
  for (;;) {
    std::size_t total = 0;
    std::optional<std::size_t> least;  // important; of equal ones the last
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!shown[c]) continue;
      total += all[c] + (total > 0 ? kGap : 0);
      if (columns_[c].rank > 0 && (!least || columns_[c].rank >= columns_[*least].rank)) least = c;
    }
    if (total <= static_cast<std::size_t>(width) || !least) return shown;
    shown[*least] = false;
  }
}

std::vector<std::string> Table::left_out(int width) const {
  const std::vector<bool> is_shown = shown(width);
  std::vector<std::string> titles;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (!is_shown[c]) titles.push_back(columns_[c].title);
  }
  return titles;
}

std::string Table::text(int width) const {
  const std::vector<bool> is_shown = shown(width);
  std::vector<std::size_t> widths = this->widths();
  const auto total = [&] {
    std::size_t sum = 0;
    for (std::size_t c = 0; c < widths.size(); ++c) sum += is_shown[c] ? widths[c] + (sum > 0 ? kGap : 0) : 0;
    return sum;
  };
  while (width > 0 && total() > static_cast<std::size_t>(width)) {
    std::optional<std::size_t> widest;
    for (std::size_t c = 1; c < widths.size(); ++c) {
      const bool may_be_cut = is_shown[c] && columns_[c].align == Align::kLeft && widths[c] > kNarrowest;
      if (may_be_cut && (!widest || widths[c] > widths[*widest])) widest = c;
    }
    if (!widest) break;
    --widths[*widest];
  }

  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (!is_shown[c]) continue;
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

std::int64_t now_utime() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace shaken::client
