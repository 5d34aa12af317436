// The fields of tables in CSV, as R, pandas, numpy, ImageJ and spreadsheets write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shaken::run {

/// What stands between two separators, without blanks and quotes.
struct CsvField {
  std::string text;
  int column;              ///< where it begins, from 1
  bool is_quoted = false;  ///< separators in it are none
};

/// What separates the fields of a line: a tab, a semicolon or a comma, which it has, or blanks.
char separator_of(std::string_view line);

/// The fields of a line. A quote within quotes is doubled.
std::vector<CsvField> fields_of(std::string_view line, char separator);

/// None if `text` is no finite number. A decimal comma is one where it separates nothing else.
std::optional<double> number_in(std::string text);

}  // namespace shaken::run
