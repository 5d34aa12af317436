#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/core/sincos.h"
#include "base/keys/nearest.h"
#include "base/text.h"
#include "run/import/csv_fields.h"
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
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
      report(0, "the file is UTF-16: save it as UTF-8, or as plain CSV");
      return {};
    }
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a mark that spreadsheets set
    const char line_end = text.find('\n') == std::string_view::npos && text.find('\r') < text.size() ? '\r' : '\n';
    std::vector<ImportedRod> rods;
    std::string_view comment;  // the last one before the first row that names columns
    bool has_header = false, is_usable = false;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(line_end, begin), text.size());
      std::string_view line = text.substr(begin, end - begin);
      begin = end + 1;
      ++line_;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      if (line.starts_with('#')) {
        if (!has_header && names_columns(line.substr(1))) comment = line.substr(1);
      } else if (line_ == 1 && line.size() == 5 && (line.starts_with("sep=") || line.starts_with("SEP="))) {
        separator_ = line.back();  // as Excel takes it
      } else if (!has_header) {
        has_header = true;
        if (!has_numbers_only(line)) {
          is_usable = read_header(line);
        } else if (!comment.empty()) {  // as numpy.savetxt writes it
          is_usable = read_header(comment);
          if (fields_of(line, *separator_).size() != n_columns_) separator_ = separator_of(line);
          if (is_usable) add_rod(line, rods);
        } else {
          report(1, fmt::format("the first line has numbers where the names of the columns should stand: put a line "
                                "before it, such as {}",
                                kExample));
        }
      } else if (is_usable) {
        add_rod(line, rods);
      }
    }
    if (!has_header) report(0, fmt::format("the file is empty: its first line names the columns, as {}", kExample));
    const auto remark = remark_on_angles(largest_angle_, "multiply them by 180/pi");
    if (has("angle") && rods.size() > 1 && remark) remarks_.push_back(*remark);
    return rods;
  }

 private:
  static constexpr const char* kExample = "x,y,nx,ny or x,y,angle";

  void report(int column, const std::string& message) {
    problems_.push_back({file_, column > 0 ? line_ : 0, column, "", message});
  }

  bool has(const std::string& name) const { return place_.contains(name); }

  std::vector<CsvField> fields(std::string_view line) const { return fields_of(line, *separator_); }

  bool has_numbers_only(std::string_view line) const {
    const std::vector<CsvField> all = fields_of(line, separator_.value_or(separator_of(line)));
    return std::all_of(all.begin(), all.end(), [](const CsvField& field) { return number_in(field.text).has_value(); });
  }
  static bool names_columns(std::string_view comment) {
    const std::vector<CsvField> names = fields_of(comment, separator_of(comment));
    return std::all_of(names.begin(), names.end(), [](const CsvField& name) { return is_column(name.text); });
  }

  void add_rod(std::string_view line, std::vector<ImportedRod>& rods) {
    if (const auto rod = read_rod(line)) rods.push_back(*rod);
  }

  bool read_header(std::string_view line) {
    const std::size_t n_before = problems_.size();
    if (!separator_) separator_ = separator_of(line);
    const std::vector<CsvField> names = fields(line);
    n_columns_ = names.size();
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

  std::optional<ImportedRod> read_rod(std::string_view line) {
    const std::size_t n_before = problems_.size();
    std::vector<CsvField> fields = this->fields(line);
    // names of rows without one of their column, as R writes them
    if (fields.size() == n_columns_ + 1 && fields.front().is_quoted) fields.erase(fields.begin());
    if (fields.size() != n_columns_) {
      report(1, fmt::format("{} for {}: each has its own", counted(fields.size(), "field"),
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
        largest_angle_ = std::max(largest_angle_, std::abs(angle));
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
  std::optional<char> separator_;
  double largest_angle_ = 0;                  ///< of all, in the plane and out of it
  int line_ = 0;                              ///< that is being read, from 1
  std::size_t n_columns_ = 0;                 ///< of the first line
  std::map<std::string, std::size_t> place_;  ///< of each column
};

}  // namespace

std::vector<ImportedRod> read_csv_rods(std::string_view text, const std::string& file,
                                       std::span<const std::string> species, std::vector<Problem>& problems,
                                       std::vector<std::string>& remarks) {
  return CsvRods(file, species, problems, remarks).read(text);
}

}  // namespace shaken::run
