// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "base/core/sincos.h"
#include "base/keys/nearest.h"
#include "base/text.h"
#include "run/import/imported_rods.h"

namespace shaken::run {
namespace {

using keys::Problem;

constexpr std::array kColumns{"x",  "y",  "z",  "nx", "ny", "nz", "angle",  "tilt",
                              "vx", "vy", "vz", "wx", "wy", "wz", "species"};
constexpr double kUnitLength = 1e-3;  ///< by which the length of a director may differ from 1
constexpr double kUpright = 90;       ///< the most that a rod is tilted [degrees]
constexpr double kMostAngle = 1e6;    ///< in the plane, also of rods that have turned round many times [degrees]

/// What stands between two commas, without blanks.
struct CsvField {
  std::string_view text;
  int column;  ///< where it begins, from 1
};

std::vector<CsvField> fields_of(std::string_view line) {
  std::vector<CsvField> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::size_t first = std::min(line.find_first_not_of(" \t", begin), end);
    std::size_t last = end;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    fields.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    begin = end + 1;
  }
  return fields;
}

/// None if `text` is no finite number.
std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (trouble != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

class CsvRods {
 public:
  CsvRods(const std::string& file, std::span<const std::string> species, std::vector<Problem>& problems)
      : file_(file), species_(species), problems_(problems) {}

  std::vector<ImportedRod> read(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a mark that spreadsheets set
    std::vector<ImportedRod> rods;
    bool has_header = false, is_usable = false;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::string_view line = text.substr(begin, end - begin);
      begin = end + 1;
      ++line_;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.find_first_not_of(" \t") == std::string_view::npos || line.starts_with('#')) continue;
      if (!has_header) {
        is_usable = read_header(line);
        has_header = true;
      } else if (is_usable) {
        if (const auto rod = read_rod(line)) rods.push_back(*rod);
      }
    }
    if (!has_header) report(0, fmt::format("the file is empty: its first line names the columns, as {}", kExample));
    return rods;
  }

 private:
  static constexpr const char* kExample = "x,y,nx,ny or x,y,angle";

  void report(int column, const std::string& message) {
    problems_.push_back({file_, column > 0 ? line_ : 0, column, "", message});
  }

  bool has(const std::string& name) const { return place_.contains(name); }

  bool read_header(std::string_view line) {
    const std::size_t n_before = problems_.size();
    const std::vector<CsvField> names = fields_of(line);
    n_columns_ = names.size();
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string name(names[k].text);
      if (std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end()) {
        const std::vector<std::string> known(kColumns.begin(), kColumns.end());
        report(names[k].column,
               fmt::format("there is no column '{}'{}; remove it, or name it as one of {}", printable(name),
                           keys::did_you_mean(keys::nearest(name, known)), fmt::join(kColumns, ", ")));
      } else if (!place_.emplace(name, k).second) {
        report(names[k].column, fmt::format("column {} is there twice: remove one", name));
      }
    }
    for (const char* name : {"x", "y"}) {
      if (!has(name)) report(1, fmt::format("column {} is missing: the centre of each rod in mm", name));
    }
    const bool by_vector = has("nx") || has("ny") || has("nz"), by_angle = has("angle") || has("tilt");
    if (by_vector && by_angle) {
      report(1, "directors are given twice: remove nx, ny and nz, or angle and tilt");
    } else if (by_vector ? !has("nx") || !has("ny") : !has("angle")) {
      report(1, fmt::format("column {} is missing: directors are given as nx, ny and nz, or as angle and tilt in "
                            "degrees; nz and tilt may be left out",
                            by_angle     ? "angle"
                            : !by_vector ? "angle (or nx and ny)"
                            : has("nx")  ? "ny"
                                         : "nx"));
    }
    if (!has("species") && species_.size() > 1) {
      report(1, fmt::format("column species is missing: the scene has {}", fmt::join(species_, " and ")));
    }
    return problems_.size() == n_before;
  }

  std::optional<ImportedRod> read_rod(std::string_view line) {
    const std::size_t n_before = problems_.size();
    const std::vector<CsvField> fields = fields_of(line);
    if (fields.size() != n_columns_) {
      report(1, fmt::format("{} for {}: each has its own, between commas", counted(fields.size(), "field"),
                            counted(n_columns_, "column")));
      return std::nullopt;
    }
    const auto value = [&](const char* name, double otherwise) {
      const auto at = place_.find(name);
      if (at == place_.end()) return otherwise;
      const CsvField& field = fields[at->second];
      const std::optional<double> number = number_in(field.text);
      if (!number) report(field.column, fmt::format("{}: '{}' is not a number", name, printable(field.text)));
      return number.value_or(0);
    };
    ImportedRod rod;
    rod.number = line_;
    rod.position = {value("x", 0), value("y", 0), value("z", ImportedRod::kResting)};
    if (has("angle")) {
      const auto degrees = [&](const char* name, double most) {
        const double angle = value(name, 0);
        if (std::abs(angle) <= most) return angle * (kPi / 180);
        report(fields[place_[name]].column,
               fmt::format("{}: {} is outside of [-{}, {}] degrees", name, angle, most, most));
        return 0.0;
      };
      const SinCos in_plane = sincos(degrees("angle", kMostAngle)), out_of_plane = sincos(degrees("tilt", kUpright));
      rod.director = {out_of_plane.cos * in_plane.cos, out_of_plane.cos * in_plane.sin, out_of_plane.sin};
    } else {
      rod.director = {value("nx", 0), value("ny", 0), value("nz", 0)};
    }
    rod.velocity = {value("vx", 0), value("vy", 0), value("vz", 0)};
    rod.angular_velocity = {value("wx", 0), value("wy", 0), value("wz", 0)};
    if (has("species")) rod.shape = species_in(fields[place_["species"]]);
    if (problems_.size() > n_before) return std::nullopt;
    if (const double length = rod.director.norm(); !(std::abs(length - 1) <= kUnitLength)) {
      report(fields[place_["nx"]].column,
             fmt::format("the director has length {:.6g}, not 1 (within {}): give unit vectors, or angles", length,
                         kUnitLength));
      return std::nullopt;
    }
    rod.director.normalize();
    return rod;
  }

  std::uint8_t species_in(const CsvField& field) {
    for (std::size_t k = 0; k < species_.size(); ++k) {
      if (field.text == species_[k] || field.text == std::to_string(k)) return static_cast<std::uint8_t>(k);
    }
    if (species_.empty()) return 0;
    report(field.column, fmt::format("species: the scene has no '{}'; it has {}, counted from 0", printable(field.text),
                                     fmt::join(species_, ", ")));
    return 0;
  }

  const std::string& file_;
  std::span<const std::string> species_;
  std::vector<Problem>& problems_;
  int line_ = 0;                              ///< that is being read, from 1
  std::size_t n_columns_ = 0;                 ///< of the first line
  std::map<std::string, std::size_t> place_;  ///< of each column
};

}  // namespace

std::vector<ImportedRod> read_csv_rods(std::string_view text, const std::string& file,
                                       std::span<const std::string> species, std::vector<Problem>& problems) {
  return CsvRods(file, species, problems).read(text);
}

}  // namespace shaken::run
