#include "run/import/csv_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "base/text.h"

namespace shaken::run {
namespace {

constexpr char kBlanks = ' ';  ///< the separator of fields with any number of blanks between them

}  // namespace

char separator_of(std::string_view line) {
  for (const char separator : {'\t', ';', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return kBlanks;
}

std::vector<CsvField> fields_of(std::string_view line, char separator) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  std::vector<CsvField> fields;
  std::size_t i = 0;
  const auto skip_blanks = [&] {
    while (i < line.size() && is_blank(line[i]) && line[i] != separator) ++i;
  };
  const auto skip_to_field = [&] {
    skip_blanks();
    while (separator == kBlanks && i < line.size() && is_blank(line[i])) ++i;
  };
  for (skip_to_field();; skip_to_field()) {
    CsvField field{"", static_cast<int>(i) + 1};
    if (i < line.size() && line[i] == '"') {
      field.is_quoted = true;
      for (++i; i < line.size() && (line[i] != '"' || (i + 1 < line.size() && line[i + 1] == '"')); ++i) {
        if (line[i] == '"') ++i;
        field.text += line[i];
      }
      if (i < line.size()) ++i;
    }
    const std::size_t rest = i;
    while (i < line.size() && line[i] != separator && !(separator == kBlanks && is_blank(line[i]))) ++i;
    std::size_t end = i;
    while (end > rest && is_blank(line[end - 1])) --end;
    field.text += line.substr(rest, end - rest);
    fields.push_back(std::move(field));
    if (separator == kBlanks) skip_to_field();
    if (i >= line.size()) return fields;
    if (separator != kBlanks) ++i;
    if (separator != kBlanks && i == line.size()) {  // nothing behind the last separator is a field too
      fields.push_back({"", static_cast<int>(i) + 1});
      return fields;
    }
  }
}

std::optional<double> number_in(std::string text) {
  if (const std::size_t comma = text.find(','); comma != std::string::npos && text.find('.') == std::string::npos)
    text[comma] = '.';
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double number = 0;
  const auto [end, trouble] = std::from_chars(begin, text.data() + text.size(), number);
  if (trouble != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

Result<std::uint8_t> species_in(const std::string& text, std::span<const std::string> names) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (text == names[k] || text == std::to_string(k)) return static_cast<std::uint8_t>(k);
  }
  return Error{fmt::format("species: the scene has no '{}'; it has {}, counted from 0", printable(text),
                           fmt::join(names, ", "))};
}

std::optional<std::string> lack_of_species(std::span<const std::string> names) {
  if (names.size() < 2) return std::nullopt;
  return fmt::format("column species is missing: the scene has {}", fmt::join(names, " and "));
}

std::optional<std::string> remark_on_angles(double largest, std::string_view cure) {
  constexpr double kMostRadians = 3.2, kAlongX = 0.1;
  if (largest > kMostRadians || largest <= kAlongX) return std::nullopt;
  return fmt::format("no angle is larger than {:.3g}: they are taken as degrees; if they are radians, {}", largest,
                     cure);
}

}  // namespace shaken::run
