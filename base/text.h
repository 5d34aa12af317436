#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace shaken {

/// "0.880 +- 0.002": an error with two figures where it begins with a 1, else with one; "0.88 (error unknown)" without.
std::string with_error(double value, double error);
/// Columns that `text` fills on a terminal: one per character, none for colour sequences.
std::size_t display_width(std::string_view text);
/// `text`, cut to `width` columns with an ellipsis if it is longer; 0 stands for any width.
std::string fitted(std::string_view text, std::size_t width);

/// Whether a text may have line breaks and tabs.
enum class Lines { kOne, kMany };
/// `text` without anything that a terminal would obey: control characters (C0, DEL, C1), characters that turn the
/// direction of writing (U+202A to U+202E, U+2066 to U+2069), and bytes that are no UTF-8 become "\u001b" or "\xff".
/// Whatever comes from a file, another program or a network is printed like this. Equal to `text` if that is harmless.
std::string printable(std::string_view text, Lines lines = Lines::kOne);

/// "0.4 s", "12 s", "3 min 20 s", "2 h 05 min", "3 d 04 h"; "?" for a negative, unknown or endless time.
std::string duration_text(double seconds);
/// The local time `seconds` from `now_utime` (microseconds since 1970): "14:32", or "Tue 14:32" on another day, or the
/// date beyond a week; "?" as in duration_text.
std::string clock_text(double seconds, std::int64_t now_utime);
/// "2026-11-29T18:42:47Z".
std::string utc_now();
/// Up to four significant digits: "0.9134", "2109", "1.2e+06".
std::string number_text(double value);
/// The longest of 1, 2, 5 times a power of ten that is at most `length`, for the bar of a scale.
double round_length(double length);
/// "1 run", "3 runs"
std::string counted(std::size_t n, std::string_view noun);
/// "3.2 MB"
std::string bytes_text(double bytes);
/// A bar of `width` columns, filled in steps of an eighth of a column.
std::string bar_text(double fraction, int width);
/// "██████····  61 %  7/12 jobs  ETA 5 min 17 s (14:32)"; an unknown time left (negative) is left out.
std::string progress_text(double fraction, const std::string& count, double eta);
/// A field of a CSV file: quoted if need be (RFC 4180).
std::string csv_field(std::string_view text);
/// Bytes in base64 (RFC 4648).
std::string base64(std::string_view bytes);
/// A word of a command line as a shell takes it: in quotes where it needs them.
std::string shell_word(std::string_view text);
/// A help text whose lines are no longer than `width` columns. What is described (an option, a verb, an example) keeps
/// its column, and its description goes on below itself; prose is broken between words. A command that is longer than
/// that stays whole, for it is there to be copied.
std::string wrapped_help(std::string_view text, std::size_t width = 80);
/// The number that `text` is as a whole; none if it is anything else.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}
/// Whether `text` has the form of a run's id: 16 hex digits.
bool is_id(std::string_view text);
/// What lies between separators, without what is empty: "/v1//jobs/" by '/' is "v1" and "jobs".
std::vector<std::string> split(std::string_view text, char separator);

}  // namespace shaken
