#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <optional>

#include "base/clock.h"

namespace shaken {
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

/// The character that UTF-8 `text` begins with, and its bytes; none if these are no UTF-8 (RFC 3629).
struct Character {
  char32_t code = 0;
  std::size_t size = 0;
};
std::optional<Character> first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < size) return std::nullopt;
  char32_t code = lead & (0x7FU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return std::nullopt;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  static constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // no longer form than needed
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast[size] || code > 0x10FFFF || is_surrogate) return std::nullopt;
  return Character{code, size};
}

bool is_obeyed(char32_t code) {
  const bool is_control = code < 0x20 || (code >= 0x7F && code <= 0x9F);
  const bool turns_the_direction = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
  return is_control || turns_the_direction;
}

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

std::string printable(std::string_view text, Lines lines) {
  std::string shown;
  while (!text.empty()) {
    const std::optional<Character> next = first_character(text);
    const std::size_t size = next ? next->size : 1;
    if (!next) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
    } else if (is_obeyed(next->code) && !(lines == Lines::kMany && (next->code == '\n' || next->code == '\t'))) {
      shown += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(next->code));
    } else {
      shown += text.substr(0, size);
    }
    text.remove_prefix(size);
  }
  return shown;
}

std::string with_error(double value, double error) {
  if (!(error > 0 && std::isfinite(error))) return fmt::format("{:.3g} (error unknown)", value);
  const double exponent = std::floor(std::log10(error));
  const int decimals = std::clamp(static_cast<int>(-exponent) + (error / std::pow(10.0, exponent) < 2 ? 1 : 0), 0, 12);
  return fmt::format("{0:.{2}f} +- {1:.{2}f}", value, error, decimals);
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

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string number_text(double value) {
  if (std::isnan(value)) return "-";
  // Whole numbers are counts: every digit matters.
  if (value == std::floor(value) && std::abs(value) < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  return length >= 5 * power ? 5 * power : length >= 2 * power ? 2 * power : power;
}

std::string counted(std::size_t n, std::string_view noun) { return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s"); }

std::string bytes_text(double bytes) {
  constexpr std::array<const char*, 5> kUnits{"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < kUnits.size()) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
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

std::string progress_text(double fraction, const std::string& count, double eta) {
  std::string text = fmt::format("{} {:3.0f} %  {}", bar_text(fraction, 24), 100 * fraction, count);
  if (eta >= 0) text += fmt::format("  ETA {} ({})", duration_text(eta), clock_text(eta, utime_now()));
  return text;
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

std::string shell_word(std::string_view text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string_view::npos) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

bool is_id(std::string_view text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    if (end > begin) parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

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
