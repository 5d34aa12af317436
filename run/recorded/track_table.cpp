#include "run/recorded/track_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text.h"
#include "run/files/recorded_frames.h"
#include "run/import/place_rods.h"
#include "run/loop/open_run.h"
#include "run/recorded/sightings.h"
#include "run/recorded/tracks.h"
#include "scene/canonical.h"
#include "sim/world.h"

namespace shaken::run {
namespace {

using keys::Problem;

constexpr double kEqual = 1e-3;        ///< by which intervals between frames may differ, of themselves
constexpr double kMostInterval = 1e5;  ///< between frames [s]
/// Tracks, or the most rods in a frame, times frames, where some are missed: each has a place of 52 bytes, seen or not.
constexpr std::size_t kMostPlaces = 20'000'000;

/// Frames of a run, made of what was seen of rods.
class SeenFrames {
 public:
  SeenFrames(Sightings table, const std::string& file, const scene::RunPlan& plan, const TrackConventions& conventions,
             std::vector<Problem>& problems)
      : table_(std::move(table)), file_(file), plan_(plan), conventions_(conventions), problems_(problems) {}

  std::optional<TrackedRods> made() {
    const std::size_t n_before = problems_.size();
    if (conventions_.filled > 0 && table_.has("id")) fill_gaps();
    note_identities();
    made_.remarks.insert(made_.remarks.end(), table_.remarks.begin(), table_.remarks.end());
    for (auto& [frame, rods] : table_.frames) {
      if (table_.has("id")) std::ranges::sort(rods, {}, &Sighting::id);
      std::ranges::stable_sort(rods, {}, &Sighting::species);
    }
    const double interval = interval_of_frames();
    if (problems_.size() > n_before) return std::nullopt;
    const auto n_rods = n_rods_of_species();
    if (!n_rods) return std::nullopt;
    number_tracks();
    auto plan = plan_of_tracks(plan_, file_, {*n_rods, table_.frames.size(), interval});
    if (!plan) {
      problems_.insert(problems_.end(), plan.error().begin(), plan.error().end());
      return std::nullopt;
    }
    made_.plan = *std::move(plan);
    std::vector<RecordedFrame> recorded;
    recorded.reserve(table_.frames.size());
    for (const Snapshot& frame : snapshots(interval)) recorded.push_back(record(frame));
    made_.lacking.insert({Needs::kImpacts, Needs::kSpins});
    if (!is_followed_) made_.lacking.insert(Needs::kIdentities);
    if (!is_followed_ || !is_complete_) made_.lacking.insert(Needs::kEveryRod);
    if (!table_.has("tilt") && !table_.has("nz")) made_.lacking.insert(Needs::kTilts);
    if (!table_.heads_are_told) made_.lacking.insert(Needs::kHeads);
    made_.frames = std::make_unique<FramesInMemory>(header(*n_rods), std::move(recorded));
    return std::move(made_);
  }

 private:
  void report(const std::string& message) { problems_.push_back({file_, 0, 0, "", message}); }

  /// Puts rods that were missed for a while between where they were before and after: straight on, by the shorter way.
  void fill_gaps() {
    std::vector<double> numbers;
    std::map<double, std::vector<std::pair<std::size_t, Sighting>>> tracks;  ///< by id, with the indices of frames
    for (const auto& [number, rods] : table_.frames) {
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
          table_.frames[numbers[index]].push_back(between(track[k - 1].second, track[k].second, part));
          table_.seen[id].insert(numbers[index]);
          ++n_filled;
        }
      }
    }
    made_.remarks.push_back(
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

  /// Whether rods can be followed, as those can that have ids, and whether each is in every frame.
  void note_identities() {
    const std::size_t n_frames = table_.frames.size(), n_tracks = table_.seen.size();
    const auto n_complete = static_cast<std::size_t>(
        std::ranges::count_if(table_.seen, [&](const auto& track) { return track.second.size() == n_frames; }));
    is_complete_ = n_complete == n_tracks || conventions_.only_complete;
    const bool is_mixture = species_names(plan_.system).size() > 1, are_few = n_tracks * n_frames <= kMostPlaces;
    is_followed_ = table_.has("id") && (is_complete_ || (are_few && !is_mixture));
    if (n_complete == n_tracks) return;
    std::string remark = fmt::format("{} of {} tracks are in every frame: ", n_complete, n_tracks);
    if (conventions_.only_complete) {
      for (auto& [frame, rods] : table_.frames)
        std::erase_if(rods, [&](const Sighting& rod) { return table_.seen[rod.id].size() < n_frames; });
      remark += "the others are left out";
      if (n_complete == 0) report("no rod is in every frame: measure without --complete");
    } else {
      remark += is_followed_ ? "lags are of the rods that are in both frames"
                : is_mixture ? "those of a mixture are not followed then"
                             : "too many tracks are short for all to be followed";
      remark += "; --complete measures these alone, and --fill N closes gaps of up to N frames before";
    }
    made_.remarks.push_back(std::move(remark));
  }

  /// From frame to frame [s]; none may be missing.
  double interval_of_frames() {
    std::vector<double> numbers, times;
    for (const auto& [frame, rods] : table_.frames) {
      numbers.push_back(frame);
      times.push_back(conventions_.interval && table_.has("frame") ? *conventions_.interval * frame
                                                                   : table_.time_of[frame]);
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

  /// Rods in a frame: their mean number, or of several species the number of each, which must be that of every frame.
  std::optional<std::vector<std::size_t>> n_rods_of_species() {
    std::size_t n_all = 0, least = std::numeric_limits<std::size_t>::max(), most = 0;
    for (const auto& [frame, rods] : table_.frames) {
      n_all += rods.size();
      least = std::min(least, rods.size());
      most = std::max(most, rods.size());
    }
    const auto mean =
        static_cast<std::size_t>(std::llround(static_cast<double>(n_all) / static_cast<double>(table_.frames.size())));
    most_in_frame_ = most;
    const std::size_t n_places = most * table_.frames.size();
    if (n_places > std::max(kMostPlaces, 2 * n_all)) {
      report(
          fmt::format("a frame has {} rods, where there are {} on average: leave out what are none there", most, mean));
      return std::nullopt;
    }
    if (least < most) {
      made_.remarks.push_back(fmt::format("{} to {} rods in a frame, {} on average", least, most, mean));
    }
    const std::vector<std::string> species = species_names(plan_.system);
    if (species.size() < 2) return std::vector{std::max<std::size_t>(mean, 1)};
    std::vector<std::size_t> first;
    for (const auto& [number, rods] : table_.frames) {
      std::vector<std::size_t> n(species.size());
      for (const Sighting& rod : rods) ++n[rod.species];
      if (first.empty()) first = n;
      for (std::size_t k = 0; k < n.size(); ++k) {
        if (first[k] == 0) report(fmt::format("the first frame has no rod of the species {}", species[k]));
      }
      if (std::ranges::count(first, 0U) > 0) return std::nullopt;
      if (n == first) continue;
      report(
          fmt::format("of several species each frame must have as many, and frame {:g} has others than the first: "
                      "see --complete",
                      number));
      return std::nullopt;
    }
    return first;
  }

  /// Each rod that is followed has a number of its own, as far as some are missed; others have that in their frame.
  void number_tracks() {
    n_tracks_ = most_in_frame_;
    if (!is_followed_ || is_complete_) return;
    for (const auto& [id, frames] : table_.seen) track_of_.emplace(id, static_cast<std::uint32_t>(track_of_.size()));
    n_tracks_ = track_of_.size();
  }

  /// Rods in the box; with --wrap their paths go on beyond it, otherwise they end at its border and begin at the other.
  /// They have velocities where they can be followed, and none is missed.
  std::vector<Snapshot> snapshots(double interval) {
    const Tick spacing = ticks_between(interval, plan_);
    std::vector<Snapshot> frames;
    std::vector<LastSeen> last(is_followed_ && !conventions_.wraps ? n_tracks_ : 0);
    for (const auto& [number, rods] : table_.frames) {
      Snapshot frame;
      frame.tick = spacing * static_cast<Tick>(frames.size());
      frame.time = static_cast<double>(frame.tick) * made_.plan.system.dt;
      frame.box = made_.plan.system.box();
      frame.n_tracks = n_tracks_;
      for (const Sighting& rod : rods) {
        const auto in_frame = static_cast<std::uint32_t>(frame.track.size());
        frame.track.push_back(track_of_.empty() ? in_frame : track_of_.at(rod.id));
        frame.position.push_back(rod.position);
        frame.director.push_back(rod.director);
      }
      fold_into_box(frame, period_, last);
      frame.velocity.assign(rods.size(), Vec3::Zero());
      frames.push_back(std::move(frame));
    }
    if (is_followed_) remark_on_jumps(frames);
    if (is_followed_ && is_complete_ && frames.size() > 1) {
      set_velocities(frames, interval);
      made_.remarks.push_back(remark_on_velocities(frames.size(), interval));
    } else {
      made_.lacking.insert(Needs::kVelocities);
    }
    return frames;
  }

  /// A word on rods that move farther than their length from one frame to the next, as mixed up ones do.
  void remark_on_jumps(const std::vector<Snapshot>& frames) {
    const double length = plan_.system.rod.length;
    std::size_t n_jumps = 0;
    for (std::size_t k = 1; k < frames.size(); ++k) {
      for (std::size_t i = 0; i < frames[k].n_rods(); ++i) {
        const auto before = frames[k - 1].rod_of(frames[k].track_of(i));
        n_jumps += before && (frames[k].unwrapped(i) - frames[k - 1].unwrapped(*before)).norm() > length ? 1 : 0;
      }
    }
    if (n_jumps == 0) return;
    made_.remarks.push_back(
        fmt::format("{} from a frame to the next, farther than a rod is long: are ids mixed up, or the rods in a "
                    "periodic box?",
                    counted(n_jumps, "step")));
  }

  TrajectoryHeader header(const std::vector<std::size_t>& n_rods) const {
    const scene::RunPlan& plan = made_.plan;
    TrajectoryHeader header = trajectory_header(empty_world(plan.system), scene::to_json(plan).dump(2) + "\n", {});
    header.n_rods = static_cast<int>(n_tracks_);
    header.lacking = words_of(made_.lacking);
    Cell& cell = header.cell;  // a tracker does not tell sizes: each rod is the mean one of its species
    cell.shape_of_rod.clear();
    if (n_rods.size() == 1) {
      cell.shapes.resize(1);
      cell.species_of_shape.clear();
    }
    for (std::size_t k = 0; cell.shapes.size() > 1 && k < n_rods.size(); ++k)
      cell.shape_of_rod.insert(cell.shape_of_rod.end(), n_rods[k], static_cast<std::uint8_t>(cell.first_shape_of(k)));
    return header;
  }

  Sightings table_;
  const std::string& file_;
  const scene::RunPlan& plan_;
  const TrackConventions& conventions_;
  std::vector<Problem>& problems_;
  const Vec2 period_ = period_of(plan_.system.box(), plan_.system.walls);
  bool is_followed_ = false, is_complete_ = false;
  std::size_t most_in_frame_ = 0, n_tracks_ = 0;
  std::map<double, std::uint32_t> track_of_;  ///< by id, where some are missed that are followed
  TrackedRods made_{};
};

}  // namespace

std::optional<TrackedRods> read_tracks(std::string_view text, const std::string& file, const scene::RunPlan& plan,
                                       const TrackConventions& conventions, std::vector<Problem>& problems) {
  auto table = read_sightings(text, file, plan, conventions, problems);
  return table ? SeenFrames(*std::move(table), file, plan, conventions, problems).made() : std::nullopt;
}

}  // namespace shaken::run
