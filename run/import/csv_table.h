// Tables in CSV, as R, pandas, numpy, ImageJ and spreadsheets write them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "base/core/types.h"

namespace shaken::run {

/// What stands between two separators, without blanks and quotes.
struct CsvField {
  std::string text;
  int column;              ///< where it begins, from 1
  bool is_quoted = false;  ///< separators in it are none
};

/// Who reads a table. Lines and columns are counted from 1; a problem with 0 is one of the whole file.
struct CsvReader {
  std::function<bool(const std::string& name)> is_column;
  std::function<bool(const std::vector<CsvField>& names, int line)> begin;  ///< whether rows can be read then
  std::function<void(std::vector<CsvField>& row, int line)> add;  ///< each of as many fields as there are names
  std::function<void(const std::string& message, int line, int column)> report;
  const char* example;  ///< of the names: "x,y,angle"
};

/// Reads a table whose first line, or the comment before it, names the columns. Fields are separated by what that line
/// has: a tab, a semicolon, a comma, or blanks. A quote within quotes is doubled.
void read_csv(std::string_view text, const CsvReader& reader);

/// None if `text` is no finite number. A decimal comma is one where it separates nothing else.
std::optional<double> decimal_in(std::string text);

/// A unit vector from its angle to the x axis in the plane, and that out of the plane [rad].
Vec3 director_at(double angle, double tilt);

/// The number of the species that a field names, or counts from 0; `names` are those of the scene's. Fails with both.
Result<std::uint8_t> species_in(const std::string& text, std::span<const std::string> names);
/// What is wrong with a table without a column of species; nothing where there is but one.
std::optional<std::string> lack_of_species(std::span<const std::string> names);

/// What to say of angles none of which is larger than `largest`: that degrees may be radians, or radians degrees, and
/// what to do about it then. Nothing where they are too large or too small for that, as where all rods lie along x.
std::optional<std::string> remark_on_angles(double largest, bool is_in_radians, std::string_view cure);

}  // namespace shaken::run
