#include "run/recorded/track_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/text.h"
#include "run/files/frames_in_memory.h"
#include "run/import/csv_table.h"
#include "run/import/place_rods.h"
#include "run/loop/open_run.h"
#include "run/recorded/tracks.h"
#include "scene/canonical.h"
#include "sim/world.h"

namespace shaken::run {
namespace {

using keys::Problem;

constexpr double kRadian = kPi / 180;
constexpr double kEqual = 1e-3;  ///< by which intervals between frames may differ, of themselves
constexpr std::size_t kMostProblems = 20;
constexpr double kLargestAngle = 1e6;  ///< of whatever unit
constexpr double kMostInterval = 1e5;  ///< between frames [s]

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

/// One rod in one frame.
struct Sighting {
  double id = 0;
  Vec3 position = Vec3::Zero();  ///< outside of a periodic box where it was
  Vec3 director = Vec3::UnitX();
  std::uint8_t species = 0;
};

class TrackTable {
 public:
  TrackTable(const std::string& file, const scene::RunPlan& plan, const TrackConventions& conventions,
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

  std::optional<TrackedRods> read(std::string_view text) {
    const std::size_t n_before = problems_.size();
    read_rows(text);
    if (problems_.size() > n_before) return std::nullopt;
    if (frames_.empty()) {
      report("the table has no rods");
      return std::nullopt;
    }
    note_identities();
    const double interval = interval_of_frames();
    if (problems_.size() > n_before) return std::nullopt;
    return made(interval);
  }

 private:
  void report(const std::string& message, int line = 0, int column = 0) {
    if (problems_.size() < kMostProblems)
      problems_.push_back({file_, line, line > 0 ? std::max(column, 1) : 0, "", message});
  }
  bool has(const std::string& name) const { return place_.contains(name); }

  void read_rows(std::string_view text) {
    int first = 0;
    read_csv(text, {.is_column = [&](const std::string& name) { return is_column(name); },
                    .begin =
                        [&](const auto& names, int line) {
                          first = line;
                          return read_names(names, line);
                        },
                    .add =
                        [&](const auto& fields, int line) {
                          const bool may_be_title = line <= first + 3 && has_titles_;
                          if (!may_be_title || decimal_in(fields[place_.at("x")].text)) add(fields, line);
                        },
                    .report = [&](const auto&... problem) { report(problem...); },
                    .example = "frame,id,x,y,angle"});
  }

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
        called_[column.name] = names[k].text;
        has_titles_ = has_titles_ || names[k].text == kHeadsAreFour;
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
    if (const auto lack = lack_of_species(species_); lack && !has("species")) report(*lack, line);
    if (has("frame") && !has("t") && !conventions_.interval)
      report("the table has numbers of frames and no times: --interval says the time from one to the next", line);
    return problems_.size() == n_before;
  }

  void add(const std::vector<CsvField>& fields, int line) {
    bool is_missed = false;
    const auto value = [&](const char* name, double otherwise) {
      const auto at = place_.find(name);
      if (at == place_.end()) return otherwise;
      const CsvField& field = fields[at->second];
      const bool is_nan = field.text.empty() || field.text == "nan" || field.text == "NaN" || field.text == "NA";
      is_missed = is_missed || is_nan;
      if (is_nan) return otherwise;
      const std::optional<double> number = decimal_in(field.text);
      if (!number) report(fmt::format("{}: '{}' is not a number", name, printable(field.text)), line, field.column);
      return number.value_or(otherwise);
    };
    const bool flips = conventions_.flips_y;
    Sighting rod;
    rod.id = value("id", -1 - line);  // without one, it is seen but once
    is_missed = false;
    rod.position = {conventions_.scale * value("x", 0), conventions_.scale * value("y", 0),
                    has("z") ? conventions_.scale * value("z", 0) : plan_.system.gap / 2};
    if (flips) rod.position.y() = view_.y() - rod.position.y();
    if (species_.size() > 1) {
      const CsvField& field = fields[place_.at("species")];
      const Result<std::uint8_t> species = species_in(field.text, species_);
      if (!species) report(species.error().message, line, field.column);
      rod.species = species ? *species : std::uint8_t{0};
      if (has("id") && species_of_.emplace(rod.id, rod.species).first->second != rod.species)
        report(fmt::format("rod {:g} is of another species than before", rod.id), line, field.column);
    }
    const bool was_missed = is_missed;
    if (has("angle")) {
      const double unit = in_radians() ? 1 : kRadian;
      const double angle = value("angle", 0), tilt = value("tilt", 0);
      largest_angle_ = std::max(largest_angle_, std::abs(angle));
      if (std::max(std::abs(angle), std::abs(tilt)) > kLargestAngle) {
        report(fmt::format("an angle is larger than {:g}", kLargestAngle), line);
        return;
      }
      rod.director = director_at(unit * angle, unit * tilt);
    } else {
      rod.director = {value("nx", 0), value("ny", 0), value("nz", 0)};
      const double length = rod.director.norm();
      is_missed = is_missed || length == 0;
      if (length > 0) rod.director /= length;
    }
    if (!has_axis_[rod.species]) {  // whatever stands there
      rod.director = Vec3::UnitX();
      is_missed = was_missed;
    }
    if (flips && called_["angle"] != kCountedUpwards) rod.director.y() = -rod.director.y();
    const double frame = has("frame") ? value("frame", 0) : value("t", 0);
    if (has("t")) time_of_.emplace(frame, value("t", 0));
    if (is_missed) {
      ++n_missed_;
      return;
    }
    const Box box = plan_.system.box();
    for (const Eigen::Index k : {0, 1}) {
      const bool folds = conventions_.wraps && period_[k] > 0;
      const double least = folds ? -kMostBoxes * box[k] : 0, most = folds ? kMostBoxes * box[k] : view_[k];
      if (rod.position[k] >= least && rod.position[k] <= most) {
        rod.position[k] += (box[k] - view_[k]) / 2;
        continue;
      }
      report(
          fmt::format("{} = {:.6g} mm is outside of the {}, which is {:.6g} mm long: see --scale{}", k == 0 ? "x" : "y",
                      rod.position[k], period_[k] > 0 ? "box" : "arena", view_[k], period_[k] > 0 ? " and --wrap" : ""),
          line);
      return;
    }
    std::vector<Sighting>& there = frames_[frame];
    there.push_back(rod);
    if (has("id") && !seen_[rod.id].insert(frame).second)
      report(fmt::format("rod {:g} is twice in frame {:g}", rod.id, frame), line);
  }

  bool in_radians() { return conventions_.radians.value_or(called_["angle"] == kInRadians); }

  /// Puts rods that were missed for a while between where they were before and after: straight on, by the shorter way.
  void fill_gaps() {
    std::vector<double> numbers;
    std::map<double, std::vector<std::pair<std::size_t, Sighting>>> tracks;  ///< by id, with the indices of frames
    for (const auto& [number, rods] : frames_) {
      for (const Sighting& rod : rods) tracks[rod.id].emplace_back(numbers.size(), rod);
      numbers.push_back(number);
    }
    const auto most = static_cast<std::size_t>(conventions_.filled);
    std::size_t n_filled = 0;
    for (const auto& [id, track] : tracks) {
      for (std::size_t k = 1; k < track.size(); ++k) {
        const std::size_t from = track[k - 1].first, to = track[k].first;
        for (std::size_t index = from + 1; index < to && to - from - 1 <= most; ++index) {
          const double part = static_cast<double>(index - from) / static_cast<double>(to - from);
          frames_[numbers[index]].push_back(between(track[k - 1].second, track[k].second, part));
          seen_[id].insert(numbers[index]);
          ++n_filled;
        }
      }
    }
    remarks_.push_back(
        fmt::format("{} interpolated, over {} at most", counted(n_filled, "sighting"), counted(most, "frame")));
  }

  Sighting between(const Sighting& before, const Sighting& after, double part) const {
    Vec3 step = after.position - before.position;
    for (const Eigen::Index k : {0, 1}) {
      if (period_[k] > 0 && !conventions_.wraps) step[k] -= period_[k] * std::round(step[k] / period_[k]);
    }
    const double cosine = before.director.dot(after.director);
    const Vec3 end = cosine < 0 ? Vec3(-after.director) : after.director;  // of an axis either is meant
    const double angle = std::acos(std::min(1.0, std::abs(cosine)));
    const Vec3 turned =
        angle < 1e-9
            ? before.director
            : Vec3((std::sin((1 - part) * angle) * before.director + std::sin(part * angle) * end) / std::sin(angle));
    return {before.id, before.position + part * step, turned.normalized(), before.species};
  }

  /// Whether heads are told, of every species that has axes.
  void note_heads() {
    std::vector<HeadsSeen> heads(species_.size());
    for (const auto& [number, rods] : frames_) {
      for (const Sighting& rod : rods) heads[rod.species].see(rod.director);
    }
    for (std::size_t k = 0; k < heads.size(); ++k)
      heads_are_told_ = heads_are_told_ && (heads[k].are_told() || !has_axis_[k]);
  }

  /// Which rods can be followed.
  void note_identities() {
    note_heads();  // of what was seen: a rod that is filled in may turn by the other side
    if (conventions_.filled > 0 && has("id")) fill_gaps();
    const std::size_t n = frames_.size();
    if (has("id")) {
      const auto n_complete = static_cast<std::size_t>(
          std::ranges::count_if(seen_, [&](const auto& track) { return track.second.size() == n; }));
      is_followed_ = n_complete == seen_.size();
      if (!is_followed_ && conventions_.only_complete) {
        for (auto& [frame, rods] : frames_)
          std::erase_if(rods, [&](const Sighting& rod) { return seen_[rod.id].size() < n; });
        remarks_.push_back(
            fmt::format("{} of {} tracks are in every frame: the others are left out", n_complete, seen_.size()));
        if (n_complete == 0) report("no rod is in every frame: measure without --complete");
        is_followed_ = true;
      } else if (!is_followed_) {
        remarks_.push_back(
            fmt::format("{} of {} tracks are in every frame: --complete measures these alone, and then follows them; "
                        "--fill N closes gaps of up to N frames before",
                        n_complete, seen_.size()));
      }
    }
    for (auto& [frame, rods] : frames_) {
      if (has("id")) std::ranges::sort(rods, {}, &Sighting::id);
      std::ranges::stable_sort(rods, {}, &Sighting::species);
    }
    if (n_missed_ > 0) remarks_.push_back(fmt::format("{} without a position or an angle", counted(n_missed_, "row")));
    const auto remark = remark_on_angles(largest_angle_, "give --radians");
    if (has("angle") && !in_radians() && remark) remarks_.push_back(*remark);
  }

  /// From frame to frame [s]; none may be missing.
  double interval_of_frames() {
    std::vector<double> numbers, times;
    for (const auto& [frame, rods] : frames_) {
      numbers.push_back(frame);
      times.push_back(conventions_.interval && has("frame") ? *conventions_.interval * frame : time_of_[frame]);
    }
    if (times.size() == 1) return conventions_.interval.value_or(plan_.system.dt);
    const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    if (!(interval > 0 && interval <= kMostInterval))
      report(fmt::format("frames are {:.6g} s apart on average: more than 0 s, and up to {:g} s, is read", interval,
                         kMostInterval));
    for (std::size_t k = 1; interval > 0 && k < times.size(); ++k) {
      if (std::abs(times[k] - times[k - 1] - interval) <= kEqual * interval) continue;
      report(
          fmt::format("frames {:g} and {:g} are {:.6g} s apart, where others are {:.6g} s: frames without a rod, or "
                      "missing ones, are not measured across",
                      numbers[k - 1], numbers[k], times[k] - times[k - 1], interval));
      break;
    }
    return interval;
  }

  std::optional<TrackedRods> made(double interval) {
    std::size_t n_all = 0, least = std::numeric_limits<std::size_t>::max(), most = 0;
    for (const auto& [frame, rods] : frames_) {
      n_all += rods.size();
      least = std::min(least, rods.size());
      most = std::max(most, rods.size());
    }
    const auto mean =
        static_cast<std::size_t>(std::llround(static_cast<double>(n_all) / static_cast<double>(frames_.size())));
    std::vector<std::size_t> n_rods{std::max<std::size_t>(mean, 1)};
    if (species_.size() > 1) {
      n_rods = n_of_species(frames_.begin()->second);
      for (std::size_t k = 0; k < n_rods.size(); ++k) {
        if (n_rods[k] == 0) report(fmt::format("the first frame has no rod of the species {}", species_[k]));
      }
      if (std::ranges::find(n_rods, 0U) != n_rods.end()) return std::nullopt;
      for (const auto& [number, rods] : frames_) {
        if (n_of_species(rods) == n_rods) continue;
        report(
            fmt::format("of several species each frame must have as many, and frame {:g} has others than the first: "
                        "see --complete",
                        number));
        return std::nullopt;
      }
    }
    auto plan = plan_of_tracks(plan_, file_, {n_rods, frames_.size(), interval});
    if (!plan) {
      problems_.insert(problems_.end(), plan.error().begin(), plan.error().end());
      return std::nullopt;
    }
    TrackedRods found;
    found.has_constant_number = least == most;
    found.lacking = {Needs::kImpacts, Needs::kSpins};
    if (!is_followed_) found.lacking.insert(Needs::kIdentities);
    if (!has("tilt") && !has("nz")) found.lacking.insert(Needs::kTilts);
    if (least < most) remarks_.push_back(fmt::format("{} to {} rods in a frame, {} on average", least, most, mean));

    const Tick spacing = ticks_between(interval, plan_);
    std::vector<Snapshot> frames;
    for (const auto& [number, rods] : frames_) {
      const Snapshot* before = is_followed_ && !frames.empty() ? &frames.back() : nullptr;
      frames.push_back(snapshot_of(rods, spacing * static_cast<Tick>(frames.size()), *plan, before));
    }
    if (is_followed_ && frames.size() > 1) {
      set_velocities(frames, interval);
      remarks_.push_back(remark_on_velocities(frames.size(), interval));
    } else {
      found.lacking.insert(Needs::kVelocities);
    }
    if (!heads_are_told_) found.lacking.insert(Needs::kHeads);
    std::vector<RecordedFrame> recorded;
    recorded.reserve(frames.size());
    for (const Snapshot& frame : frames) recorded.push_back(record(frame));
    TrajectoryHeader header = trajectory_header(empty_world(plan->system), scene::to_json(*plan).dump(2) + "\n", {});
    header.n_rods = static_cast<int>(mean);
    header.lacking = words_of(found.lacking);
    Cell& cell = header.cell;  // a tracker does not tell sizes: each rod is the mean one of its species
    cell.shape_of_rod.clear();
    for (std::size_t k = 0; cell.shapes.size() > 1 && k < n_rods.size(); ++k)
      cell.shape_of_rod.insert(cell.shape_of_rod.end(), n_rods[k], static_cast<std::uint8_t>(cell.first_shape_of(k)));
    found.frames = std::make_unique<FramesInMemory>(std::move(header), std::move(recorded));
    found.plan = *std::move(plan);
    found.remarks = std::move(remarks_);
    return found;
  }

  std::vector<std::size_t> n_of_species(const std::vector<Sighting>& rods) const {
    std::vector<std::size_t> n(species_.size());
    for (const Sighting& rod : rods) ++n[rod.species];
    return n;
  }

  /// Rods in the box; with --wrap their paths go on beyond it, otherwise they end at its border and begin at the other.
  Snapshot snapshot_of(const std::vector<Sighting>& rods, Tick tick, const scene::RunPlan& plan,
                       const Snapshot* before) const {
    Snapshot frame;
    frame.tick = tick;
    frame.time = static_cast<double>(tick) * plan.system.dt;
    frame.box = plan.system.box();
    for (const Sighting& rod : rods) {
      frame.position.push_back(rod.position);
      frame.director.push_back(rod.director);
    }
    fold_into_box(frame, period_, conventions_.wraps ? nullptr : before);
    frame.velocity.assign(rods.size(), Vec3::Zero());
    return frame;
  }

  const std::string& file_;
  const scene::RunPlan& plan_;
  const TrackConventions& conventions_;
  std::vector<Problem>& problems_;
  const std::vector<std::string> species_ = species_names(plan_.system);
  std::vector<bool> has_axis_;  ///< of each species; spheres need no angle
  const Vec2 period_ = period_of(plan_.system.box(), plan_.system.walls);
  Vec2 view_;  ///< sides of what the table is of: the box, or the rectangle around the arena [mm]
  std::vector<std::string> remarks_;
  std::map<std::string, std::size_t> place_;        ///< of each column
  std::map<std::string, std::string> called_;       ///< by the table
  bool has_titles_ = false;                         ///< more lines of them may follow the names
  std::map<double, std::vector<Sighting>> frames_;  ///< by number, or by time
  std::map<double, double> time_of_;                ///< of frames [s]
  std::map<double, std::set<double>> seen_;         ///< in which frames a rod is
  std::map<double, std::uint8_t> species_of_;       ///< of rods that are followed
  bool is_followed_ = false;
  bool heads_are_told_ = true;
  std::size_t n_missed_ = 0;
  double largest_angle_ = 0;
};

}  // namespace

std::optional<TrackedRods> read_tracks(std::string_view text, const std::string& file, const scene::RunPlan& plan,
                                       const TrackConventions& conventions, std::vector<Problem>& problems) {
  return TrackTable(file, plan, conventions, problems).read(text);
}

}  // namespace shaken::run
