#include "run/recorded/sightings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "run/import/csv_table.h"
#include "run/import/place_rods.h"
#include "run/recorded/tracks.h"
#include "sim/world.h"

namespace shaken::run {
namespace {

using keys::Problem;

constexpr double kRadian = kPi / 180;
constexpr std::size_t kMostProblems = 20;
constexpr double kLargestAngle = 1e6;  ///< of whatever unit

/// What a column is, and what trackers call it: trackpy, TrackMate, ImageJ, and others.
struct Column {
  const char* name;
  std::vector<const char*> known_as;
};
const std::vector<Column>& columns() {
  static const std::vector<Column> all{{"frame", {"frame", "FRAME", "Frame", "Slice"}},
                                       {"t", {"t", "time", "time_s", "t_s", "POSITION_T"}},
                                       {"id", {"id", "particle", "TRACK_ID", "track", "Track"}},
                                       {"x", {"x", "X", "POSITION_X"}},
                                       {"y", {"y", "Y", "POSITION_Y"}},
                                       {"z", {"z"}},
                                       {"angle", {"angle", "Angle", "theta", "ELLIPSE_THETA"}},
                                       {"tilt", {"tilt"}},
                                       {"nx", {"nx"}},
                                       {"ny", {"ny"}},
                                       {"nz", {"nz"}},
                                       {"species", {"species"}}};
  return all;
}
std::string known_columns() {
  std::vector<std::string_view> names;
  for (const Column& column : columns()) names.emplace_back(column.name);
  return fmt::format("{}", fmt::join(names, ", "));
}
constexpr std::string_view kInRadians = "ELLIPSE_THETA";
constexpr std::string_view kCountedUpwards = "Angle";   ///< ImageJ measures it as one sees it, but y from the top
constexpr std::string_view kHeadsAreFour = "TRACK_ID";  ///< TrackMate has three more lines of titles below its names

/// The rows of a table, as the conventions say what they mean.
class TrackRows {
 public:
  TrackRows(const std::string& file, const scene::RunPlan& plan, const TrackConventions& conventions,
            std::vector<Problem>& problems)
      : file_(file), plan_(plan), conventions_(conventions), problems_(problems) {
    has_axis_.push_back(plan.system.rod.has_axis());
    for (const auto& added : plan.system.added) {
      if (added) has_axis_.push_back(added->rod.has_axis());
    }
    for (const Eigen::Index k : {0, 1}) {
      view_[k] = period_[k] > 0 ? plan.system.box()[k] : plan.system.walls->extent()[k];
    }
  }

  std::optional<Sightings> read(std::string_view text) {
    const std::size_t n_before = problems_.size();
    read_csv(text, {.is_column = [&](const auto& name) { return is_column(name); },
                    .begin = [&](const auto& names, int line) { return read_names(names, line); },
                    .add =
                        [&](const auto& fields, int line) {
                          add({fields, line});
                        },
                    .report = [&](const auto&... problem) { report(problem...); },
                    .example = "frame,id,x,y,angle"});
    for (const auto& [kind, repeated] : repeated_) {
      const std::string more = repeated.n > 1 ? fmt::format(" (and {} more)", counted(repeated.n - 1, "row")) : "";
      report(repeated.first + more, repeated.line, repeated.column);
    }
    if (found_.frames.empty() && problems_.size() == n_before) report("the table has no rods");
    if (problems_.size() > n_before) return std::nullopt;
    for (std::size_t k = 0; k < heads_.size(); ++k) {
      found_.heads_are_told = found_.heads_are_told && (heads_[k].are_told() || !has_axis_[k]);
    }
    if (n_missed_ > 0) {
      found_.remarks.push_back(fmt::format("{} without a position, an angle or a time", counted(n_missed_, "row")));
    }
    const char* const cure = is_in_radians_ ? "give --degrees" : "give --radians";
    const auto remark = remark_on_angles(largest_angle_, is_in_radians_, cure);
    if (has("angle") && remark) found_.remarks.push_back(*remark);
    for (const auto& [column, place] : place_) found_.columns.insert(column);
    return std::move(found_);
  }

 private:
  struct Repeated {
    std::string first;  ///< what is wrong with the first row
    int line, column;
    std::size_t n = 0;
  };
  struct Row {
    const std::vector<CsvField>& fields;
    int line;
    bool is_missed = false;  ///< it lacks a number of what has been read
  };

  void report(const std::string& message, int line = 0, int column = 0) {
    if (problems_.size() < kMostProblems)
      problems_.push_back({file_, line, line > 0 ? std::max(column, 1) : 0, "", message});
  }
  /// What may be wrong with every row alike is said of the first, with the number of the others.
  void report_once(const std::string& kind, const std::string& message, int line, int column = 0) {
    if (repeated_.size() >= kMostProblems && !repeated_.contains(kind)) return;
    ++repeated_.try_emplace(kind, Repeated{message, line, column}).first->second.n;
  }
  bool has(const std::string& name) const { return place_.contains(name); }

  bool is_column(const std::string& name) const {
    return std::ranges::any_of(columns(),
                               [&](const Column& column) { return std::ranges::count(names_of(column), name) > 0; });
  }

  /// What a column may be called here.
  std::vector<std::string> names_of(const Column& column) const {
    const auto given = conventions_.columns.find(column.name);
    if (given != conventions_.columns.end()) return {given->second};
    return {column.known_as.begin(), column.known_as.end()};
  }

  bool read_names(const std::vector<CsvField>& names, int line) {
    const std::size_t n_before = problems_.size();
    for (const auto& [name, given] : conventions_.columns) {
      if (std::ranges::find(columns(), name, &Column::name) == columns().end())
        report(fmt::format("--columns {}={}: a table has {}", printable(name), printable(given), known_columns()));
    }
    for (const Column& column : columns()) {
      const std::vector<std::string> wanted = names_of(column);
      for (std::size_t k = 0; k < names.size(); ++k) {
        if (std::ranges::find(wanted, names[k].text) == wanted.end()) continue;
        if (!place_.emplace(column.name, k).second) {
          report(fmt::format("{} and {} are both {}: choose one by --columns {}=NAME",
                             printable(names[place_[column.name]].text), printable(names[k].text), column.name,
                             column.name),
                 line, names[k].column);
        }
        if (names[k].text == kHeadsAreFour) last_title_ = line + 3;
      }
      if (conventions_.columns.contains(column.name) && !has(column.name))
        report(fmt::format("there is no column '{}', which --columns names", printable(wanted.front())), line);
    }
    std::vector<std::string> missing;
    for (const char* name : {"x", "y"}) {
      if (!has(name)) missing.emplace_back(name);
    }
    if (!has("angle") && !(has("nx") && has("ny"))) missing.emplace_back("angle");
    if (!has("frame") && !has("t")) missing.emplace_back("frame");
    if (!missing.empty()) {
      report(fmt::format("no column is {}: name {} by --columns {}=NAME", fmt::join(missing, ", or "),
                         missing.size() > 1 ? "them" : "it", fmt::join(missing, "=NAME,")),
             line);
    }
    if (const auto lack = lack_of_species(species_); lack && !has("species"))
      report(*lack + "; --columns species=NAME says what it is called", line);
    if (has("frame") && !has("t") && !conventions_.interval)
      report("the table has numbers of frames and no times: --interval says the time from one to the next", line);
    if (has("angle")) {
      const std::string& called = names[place_["angle"]].text;
      is_in_radians_ = conventions_.radians.value_or(called == kInRadians);
      is_counted_upwards_ = called == kCountedUpwards;
    }
    return problems_.size() == n_before;
  }

  void add(Row row) {
    if (row.line <= last_title_ && !decimal_in(row.fields[place_.at("x")].text)) return;
    Sighting rod;
    rod.id = value(row, "id", -1 - row.line);  // without one, it is seen but once
    row.is_missed = false;
    rod.position = {conventions_.scale * value(row, "x", 0), conventions_.scale * value(row, "y", 0),
                    has("z") ? conventions_.scale * value(row, "z", 0) : plan_.system.gap / 2};
    if (conventions_.flips_y) rod.position.y() = view_.y() - rod.position.y();
    rod.species = species_of(row, rod.id);
    const bool has_no_position = row.is_missed;
    const auto director = director_of(row);
    if (!director) return;
    if (has_axis_[rod.species]) {
      rod.director = *director;
    } else {  // whatever stands there
      row.is_missed = has_no_position;
    }
    if (conventions_.flips_y && !is_counted_upwards_) rod.director.y() = -rod.director.y();
    Row instant{row.fields, row.line};
    const double frame = value(instant, has("frame") ? "frame" : "t", 0), time = value(instant, "t", 0);
    if (has("t") && !instant.is_missed) found_.time_of.emplace(frame, time);
    row.is_missed |= instant.is_missed;
    n_missed_ += row.is_missed ? 1 : 0;
    if (row.is_missed || !put_into_box(rod.position, row.line)) return;
    found_.frames[frame].push_back(rod);
    heads_[rod.species].see(rod.director);
    if (has("id") && !found_.seen[rod.id].insert(frame).second)
      report(fmt::format("rod {:g} is twice in frame {:g}", rod.id, frame), row.line);
  }

  double value(Row& row, const char* name, double otherwise) {
    const auto at = place_.find(name);
    if (at == place_.end()) return otherwise;
    const CsvField& field = row.fields[at->second];
    const bool is_nan = field.text.empty() || field.text == "nan" || field.text == "NaN" || field.text == "NA";
    row.is_missed = row.is_missed || is_nan;
    if (is_nan) return otherwise;
    const std::optional<double> number = decimal_in(field.text);
    if (!number) report(fmt::format("{}: '{}' is not a number", name, printable(field.text)), row.line, field.column);
    return number.value_or(otherwise);
  }

  std::uint8_t species_of(const Row& row, double id) {
    if (species_.size() < 2) return 0;
    const CsvField& field = row.fields[place_.at("species")];
    const auto given = conventions_.species.find(field.text);
    const Result<std::uint8_t> named =
        species_in(given != conventions_.species.end() ? given->second : field.text, species_);
    if (!named) {
      report_once("species " + field.text,
                  fmt::format("{}; --species {}=NAME says which it is", named.error().message, printable(field.text)),
                  row.line, field.column);
    }
    const std::uint8_t species = named ? *named : std::uint8_t{0};
    if (has("id") && species_by_id_.emplace(id, species).first->second != species)
      report(fmt::format("rod {:g} is of another species than before", id), row.line, field.column);
    return species;
  }

  /// None if it is no direction. A director of length 0 is one that was missed.
  std::optional<Vec3> director_of(Row& row) {
    if (has("angle")) {
      const double unit = is_in_radians_ ? 1 : kRadian;
      const double angle = value(row, "angle", 0), tilt = value(row, "tilt", 0);
      largest_angle_ = std::max(largest_angle_, std::abs(angle));
      if (std::max(std::abs(angle), std::abs(tilt)) <= kLargestAngle) return director_at(unit * angle, unit * tilt);
      report(fmt::format("an angle is larger than {:g}", kLargestAngle), row.line);
      return std::nullopt;
    }
    const Vec3 director{value(row, "nx", 0), value(row, "ny", 0), value(row, "nz", 0)};
    const double length = director.norm();
    row.is_missed = row.is_missed || length == 0;
    return length > 0 ? Vec3(director / length) : director;
  }

  /// From what the table is of to the box around it. Whether it is inside, or may be folded into it.
  bool put_into_box(Vec3& position, int line) {
    const Box box = plan_.system.box();
    for (const Eigen::Index k : {0, 1}) {
      const bool folds = conventions_.wraps && period_[k] > 0;
      const double least = folds ? -kMostBoxes * box[k] : 0, most = folds ? kMostBoxes * box[k] : view_[k];
      if (position[k] >= least && position[k] <= most) {
        position[k] += (box[k] - view_[k]) / 2;
        continue;
      }
      const std::string axis = k == 0 ? "x" : "y";
      report_once(
          axis,
          fmt::format("{} = {:.6g} mm is outside of the {}, which is {:.6g} mm long: see --scale{}", axis, position[k],
                      period_[k] > 0 ? "box" : "arena", view_[k], period_[k] > 0 ? " and --wrap" : ""),
          line);
      return false;
    }
    return true;
  }

  const std::string& file_;
  const scene::RunPlan& plan_;
  const TrackConventions& conventions_;
  std::vector<Problem>& problems_;
  const std::vector<std::string> species_ = species_names(plan_.system);
  std::vector<bool> has_axis_;  ///< of each species; spheres need no angle
  std::vector<HeadsSeen> heads_{species_.size()};
  const Vec2 period_ = period_of(plan_.system.box(), plan_.system.walls);
  Vec2 view_;  ///< sides of what the table is of: the box, or the rectangle around the arena [mm]
  std::map<std::string, std::size_t> place_;                 ///< of each column
  int last_title_ = 0;                                       ///< up to this line there may be more than the names
  bool is_in_radians_ = false, is_counted_upwards_ = false;  ///< the angle
  std::map<double, std::uint8_t> species_by_id_;
  std::map<std::string, Repeated> repeated_;  ///< by kind
  std::size_t n_missed_ = 0;
  double largest_angle_ = 0;
  Sightings found_;
};

}  // namespace

std::optional<Sightings> read_sightings(std::string_view text, const std::string& file, const scene::RunPlan& plan,
                                        const TrackConventions& conventions, std::vector<Problem>& problems) {
  return TrackRows(file, plan, conventions, problems).read(text);
}

}  // namespace shaken::run
