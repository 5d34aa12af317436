// The fields of tables in CSV, as R, pandas, numpy, ImageJ and spreadsheets write them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"

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

/// The number of the species that a field names, or counts from 0; `names` are those of the scene's. Fails with both.
Result<std::uint8_t> species_in(const std::string& text, std::span<const std::string> names);
/// What is wrong with a table without a column of species; nothing where there is but one.
std::optional<std::string> lack_of_species(std::span<const std::string> names);

/// What to say of angles in degrees none of which is larger than `largest`: that they may be radians, and what to do
/// about it then. Nothing where they are too large for that, or so small that all rods lie along x.
std::optional<std::string> remark_on_angles(double largest, std::string_view cure);

}  // namespace shaken::run
