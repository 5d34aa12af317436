#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/keys/nearest.h"
#include "base/text.h"
#include "run/import/csv_table.h"
#include "run/import/imported_rods.h"

namespace shaken::run {
namespace {

using keys::Problem;

constexpr std::array kColumns{"x",  "y",  "z",  "nx", "ny", "nz", "angle",  "tilt",
                              "vx", "vy", "vz", "wx", "wy", "wz", "species"};
constexpr double kUnitLength = 1e-3;  ///< by which the length of a director may differ from 1
constexpr double kUpright = 90;       ///< the most that a rod is tilted [degrees]
constexpr double kMostAngle = 1e6;    ///< in the plane, also of rods that have turned round many times [degrees]

bool is_column(const std::string& name) { return std::find(kColumns.begin(), kColumns.end(), name) != kColumns.end(); }

class CsvRods {
 public:
  CsvRods(const std::string& file, std::span<const std::string> species, std::vector<Problem>& problems,
          std::vector<std::string>& remarks)
      : file_(file), species_(species), problems_(problems), remarks_(remarks) {}

  std::vector<ImportedRod> read(std::string_view text) {
    std::vector<ImportedRod> rods;
    read_csv(text, {.is_column = is_column,
                    .begin = [&](const auto& names, int line) { return read_header(names, line); },
                    .add =
                        [&](const auto& fields, int line) {
                          line_ = line;
                          if (const auto rod = read_rod(fields)) rods.push_back(*rod);
                        },
                    .report =
                        [&](const std::string& message, int line, int column) {
                          line_ = line;
                          report(column, message);
                        },
                    .example = "x,y,nx,ny or x,y,angle"});
    const auto remark = remark_on_angles(largest_angle_, false, "multiply them by 180/pi");
    if (has("angle") && rods.size() > 1 && remark) remarks_.push_back(*remark);
    return rods;
  }

 private:
  void report(int column, const std::string& message) {
    problems_.push_back({file_, column > 0 ? line_ : 0, column, "", message});
  }

  bool has(const std::string& name) const { return place_.contains(name); }

  bool read_header(const std::vector<CsvField>& names, int line) {
    const std::size_t n_before = problems_.size();
    line_ = line;
    std::vector<std::string> unknown;
    int first_unknown = 0;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string& name = names[k].text;
      if (name.empty()) continue;  // numbers of rows, as R, pandas and ImageJ write them
      if (!is_column(name)) {
        const std::vector<std::string> known(kColumns.begin(), kColumns.end());
        const std::string nearest = keys::nearest(name, known);
        if (nearest.empty()) {
          if (unknown.empty()) first_unknown = names[k].column;
          unknown.push_back(fmt::format("'{}'", printable(name)));
        } else {
          report(names[k].column,
                 fmt::format("there is no column '{}'{}", printable(name), keys::did_you_mean(nearest)));
        }
      } else if (!place_.emplace(name, k).second) {
        report(names[k].column, fmt::format("column {} is there twice: remove one", name));
      }
    }
    if (!unknown.empty()) {
      report(first_unknown, fmt::format("there {} {}: remove {}, or name {} as one of {}",
                                        unknown.size() > 1 ? "are no columns" : "is no column",
                                        fmt::join(unknown, ", "), unknown.size() > 1 ? "them" : "it",
                                        unknown.size() > 1 ? "each" : "it", fmt::join(kColumns, ", ")));
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
    const auto lack = lack_of_species(species_);
    if (!has("species") && lack) report(1, *lack);
    return problems_.size() == n_before;
  }

  std::optional<ImportedRod> read_rod(const std::vector<CsvField>& fields) {
    const std::size_t n_before = problems_.size();
    const auto value = [&](const char* name, double otherwise) {
      const auto at = place_.find(name);
      if (at == place_.end()) return otherwise;
      const CsvField& field = fields[at->second];
      const std::optional<double> number = decimal_in(field.text);
      if (!number) report(field.column, fmt::format("{}: '{}' is not a number", name, printable(field.text)));
      return number.value_or(0);
    };
    ImportedRod rod;
    rod.number = line_;
    rod.position = {value("x", 0), value("y", 0), value("z", ImportedRod::kResting)};
    if (has("angle")) {
      const auto degrees = [&](const char* name, double most) {
        const double angle = value(name, 0);
        largest_angle_ = std::max(largest_angle_, std::abs(angle));
        if (std::abs(angle) <= most) return angle * (kPi / 180);
        report(fields[place_[name]].column,
               fmt::format("{}: {} is outside of [-{}, {}] degrees", name, angle, most, most));
        return 0.0;
      };
      const double in_plane = degrees("angle", kMostAngle);
      rod.director = director_at(in_plane, degrees("tilt", kUpright));
    } else {
      rod.director = {value("nx", 0), value("ny", 0), value("nz", 0)};
    }
    rod.velocity = {value("vx", 0), value("vy", 0), value("vz", 0)};
    rod.angular_velocity = {value("wx", 0), value("wy", 0), value("wz", 0)};
    if (has("species") && !species_.empty()) {
      const CsvField& field = fields[place_["species"]];
      const Result<std::uint8_t> species = species_in(field.text, species_);
      if (!species) report(field.column, species.error().message);
      rod.shape = species ? *species : std::uint8_t{0};
    }
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

  const std::string& file_;
  std::span<const std::string> species_;
  std::vector<Problem>& problems_;
  std::vector<std::string>& remarks_;
  double largest_angle_ = 0;                  ///< of all, in the plane and out of it
  int line_ = 0;                              ///< that is being read, from 1
  std::map<std::string, std::size_t> place_;  ///< of each column
};

}  // namespace

std::vector<ImportedRod> read_csv_rods(std::string_view text, const std::string& file,
                                       std::span<const std::string> species, std::vector<Problem>& problems,
                                       std::vector<std::string>& remarks) {
  return CsvRods(file, species, problems, remarks).read(text);
}

}  // namespace shaken::run
