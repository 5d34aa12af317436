#include "run/import/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/core/sincos.h"
#include "base/text.h"

namespace shaken::run {
namespace {

constexpr char kBlanks = ' ';  ///< the separator of fields with any number of blanks between them

/// What separates the fields of a line: what it has.
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

bool has_numbers_only(const std::vector<CsvField>& fields) {
  return std::ranges::all_of(fields, [](const CsvField& field) { return decimal_in(field.text).has_value(); });
}

}  // namespace

void read_csv(std::string_view text, const CsvReader& reader) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return reader.report("the file is UTF-16: save it as UTF-8, or as plain CSV", 0, 0);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a mark that spreadsheets set
  const char line_end = text.find('\n') == std::string_view::npos && text.find('\r') < text.size() ? '\r' : '\n';
  std::optional<char> separator;
  std::string_view comment;  // the last one before the first row that names columns
  std::size_t n_columns = 0;
  bool has_names = false, is_usable = false;
  int number = 0;
  const auto is_column = [&](const CsvField& name) { return reader.is_column(name.text); };
  const auto begin = [&](std::string_view line) {
    if (!separator) separator = separator_of(line);
    const std::vector<CsvField> names = fields_of(line, *separator);
    n_columns = names.size();
    is_usable = reader.begin(names, number);
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(line_end, at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    if (line.starts_with('#')) {
      line.remove_prefix(1);
      const std::vector<CsvField> names = fields_of(line, separator_of(line));
      if (!has_names && std::ranges::all_of(names, is_column)) comment = line;
      continue;
    }
    if (number == 1 && line.size() == 5 && (line.starts_with("sep=") || line.starts_with("SEP="))) {
      separator = line.back();  // as Excel takes it
      continue;
    }
    if (!std::exchange(has_names, true)) {
      const std::vector<CsvField> fields = fields_of(line, separator.value_or(separator_of(line)));
      // --columns may name columns that are called by numbers
      if (!has_numbers_only(fields) || std::ranges::any_of(fields, is_column)) {
        begin(line);
        continue;
      }
      if (comment.empty())
        return reader.report(fmt::format("the first line has numbers where the names of the columns should stand: put "
                                         "a line before it, such as {}",
                                         reader.example),
                             number, 1);
      begin(comment);  // as numpy.savetxt writes it
      if (fields_of(line, *separator).size() != n_columns) separator = separator_of(line);
    }
    if (!is_usable) return;
    std::vector<CsvField> fields = fields_of(line, *separator);
    // names of rows without one of their column, as R writes them
    if (fields.size() == n_columns + 1 && fields.front().is_quoted) fields.erase(fields.begin());
    if (fields.size() == n_columns) {
      reader.add(fields, number);
    } else {
      reader.report(
          fmt::format("{} for {}: each has its own", counted(fields.size(), "field"), counted(n_columns, "column")),
          number, 1);
    }
  }
  if (!has_names)
    reader.report(fmt::format("the file is empty: its first line names the columns, as {}", reader.example), 0, 0);
}

std::optional<double> decimal_in(std::string text) {
  if (const std::size_t comma = text.find(','); comma != std::string::npos && text.find('.') == std::string::npos)
    text[comma] = '.';
  const auto number = number_in<double>(std::string_view(text).substr(text.starts_with('+') ? 1 : 0));
  return number && std::isfinite(*number) ? number : std::nullopt;
}

Vec3 director_at(double angle, double tilt) {
  const SinCos in_plane = sincos(angle), out_of_plane = sincos(tilt);
  return {out_of_plane.cos * in_plane.cos, out_of_plane.cos * in_plane.sin, out_of_plane.sin};
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

std::optional<std::string> remark_on_angles(double largest, bool is_in_radians, std::string_view cure) {
  constexpr double kMostRadians = 3.2, kTurns = 7, kAlongX = 0.1;
  if (is_in_radians && largest > kTurns) {
    return fmt::format("angles go up to {:.3g}: they are taken as radians; if they are degrees, {}", largest, cure);
  }
  if (is_in_radians || largest > kMostRadians || largest <= kAlongX) return std::nullopt;
  return fmt::format("no angle is larger than {:.3g}: they are taken as degrees; if they are radians, {}", largest,
                     cure);
}

}  // namespace shaken::run
