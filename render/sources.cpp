#include "render/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <shaken/frame_static_t.hpp>
#include <shaken/frame_t.hpp>
#include <shaken/posts_t.hpp>
#include <shaken/sizes_t.hpp>

#include "analysis/order.h"
#include "base/files.h"
#include "base/text.h"
#include "proto/bus.h"
#include "proto/cell_codec.h"
#include "proto/channels.h"
#include "proto/frame_codec.h"
#include "render/colourings.h"
#include "render/headline.h"
#include "run/files/directory.h"
#include "run/files/foreign_file.h"
#include "run/files/order_curve.h"
#include "run/files/version.h"
#include "scene/keys/cell_limits.h"
#include "scene/keys/derived.h"
#include "scene/keys/measure_plan.h"
#include "scene/load.h"

namespace shaken::render {
namespace {

using Json = nlohmann::json;

/// Nothing if the picture can be drawn, whose source `who` tells ("the job's messages have").
Result<void> check_sizes(const std::string& who, const RodPicture& picture, const Asked& asked) {
  // Of the director field, in each direction: 0.7 GB. The largest box with rods of 4 mm needs as many.
  constexpr double kMostNodes = 4096;
  if (auto done = scene::check_cell(picture.cell, picture.n_rods()); !done)
    return Error{who + " " + done.error().message};
  const double mesh = asked.grid > 0 ? asked.grid : scene::MeasureDefects{}.grid_for(picture.rod_length());
  if ((asked.defects || asked.field) && picture.cell.box.longer() / mesh > kMostNodes) {
    return Error{
        fmt::format("a box of {} mm is too large for a picture of rods of {} mm with defects on this mesh (at most {} "
                    "nodes each way); draw it without them",
                    picture.cell.box.longer(), picture.rod_length(), kMostNodes)};
  }
  return {};
}

/// What a run says of itself, beside whose recorded `file` its summary is.
Result<Notes> notes_of(const std::filesystem::path& file, const run::Provenance& run) {
  Notes notes{{"Software", fmt::format("Shaken {}", run::version())}};
  if (!run.run_id.empty()) {
    notes.emplace_back("Run id", run.run_id);
    notes.emplace_back("Seed", fmt::format("{}", run.seed));
  }
  // The versions that the run was made with, which need not be those of this program.
  const Result<std::string> text = read_file(file.parent_path() / "summary.json");
  if (!text && may_pass(text.error())) return text.error();  // else the picture would not say where it comes from
  const Json summary = text ? Json::parse(*text, nullptr, false) : Json();
  const Json versions = summary.is_object() ? summary.value("versions", Json::object()) : Json::object();
  if (versions.is_object() && versions.contains("shaken") && versions["shaken"].is_string()) {
    notes.emplace_back("Run by", "Shaken " + printable(versions["shaken"].get<std::string>()));
  }
  if (versions.is_object() && versions.contains("physics") && versions["physics"].is_number_integer()) {
    notes.emplace_back("Physics version", fmt::format("{}", versions["physics"].get<int>()));
  }
  return notes;
}

}  // namespace

Snapshot between(const Snapshot& before, const Snapshot& after, double time, const Cell& cell) {
  constexpr double kLeastCosine = 0.5;  // of a turn
  const double share = (time - before.time) / (after.time - before.time);
  Snapshot now = share < 0.5 ? before : after;
  now.time = time;
  for (std::size_t i = 0; i < now.n_rods(); ++i) {
    const BeadRow& beads = cell.beads_of(i);
    const Vec3 from = before.unwrapped(i), way = after.unwrapped(i) - from;
    const Vec3& n = before.director[i];
    Vec3 turned = after.director[i];
    if (!beads.is_polar() && turned.dot(n) < 0) turned = -turned;
    if (way.norm() > beads.length() || turned.dot(n) < kLeastCosine) continue;
    Vec3 at = from + share * way;
    for (int axis = 0; axis < 2; ++axis) {
      if (!(cell.period()[axis] > 0)) continue;
      const double image = std::floor(at[axis] / cell.box[axis]);
      now.image[i][static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(image);
      at[axis] -= image * cell.box[axis];
    }
    now.position[i] = at;
    now.director[i] = ((1 - share) * n + share * turned).normalized();
    now.velocity[i] = (1 - share) * before.velocity[i] + share * after.velocity[i];
  }
  return now;
}

Result<TrajectorySource> TrajectorySource::open(const std::filesystem::path& run_or_file) {
  std::error_code ignored;
  const std::filesystem::path file =
      std::filesystem::is_directory(run_or_file, ignored) ? run::RunDirectory{run_or_file}.recorded() : run_or_file;
  if (!std::filesystem::exists(file, ignored)) {
    return Error{"there is no " + file.string() +
                 ": give a run directory or its trajectory.h5, of a scene with a \"trajectory\" or \"movie\" block"};
  }
  SHAKEN_TRY(run::try_to_read(file));
  run::TrajectoryReader reader = SHAKEN_TRY(run::TrajectoryReader::open(file));
  if (reader.n_frames() == 0) return Error{file.string() + " holds no complete frame yet"};
  TrajectorySource source(file, std::move(reader));
  // Another version's scene may be none to this one; nothing is then known of the plates.
  if (auto plan = scene::load_scene(source.reader_.header().scene_json, file.string())) {
    source.plan_ = std::move(*plan);
    source.plates_ = PlateMotion(source.plan_->system);
  }
  source.notes_ = SHAKEN_TRY(notes_of(file, source.reader_.header().provenance));
  return source;
}

Result<double> TrajectorySource::time_of(std::size_t index) const {
  if (const auto known = times_.find(index); known != times_.end()) return known->second;
  const Snapshot frame = SHAKEN_TRY(reader_.frame(index));
  times_[index] = frame.time;
  return frame.time;
}

Result<std::size_t> TrajectorySource::nearest_frame(double time) const {
  // First frame at or after `time`, by bisection.
  std::size_t low = 0, high = n_frames();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const double at = SHAKEN_TRY(time_of(middle));
    if (at < time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low == n_frames()) return low - 1;
  if (low == 0) return low;
  const double before = SHAKEN_TRY(time_of(low - 1)), after = SHAKEN_TRY(time_of(low));
  return time - before <= after - time ? low - 1 : low;
}

Result<std::size_t> TrajectorySource::recorded_frame(double time) const {
  const double first = SHAKEN_TRY(time_of(0)), last = SHAKEN_TRY(time_of(n_frames() - 1));
  const double apart = n_frames() > 1 ? (last - first) / static_cast<double>(n_frames() - 1) : 1e-3;
  if (time >= first - apart && time <= last + apart) return nearest_frame(time);
  return Error{fmt::format("{}: there is no frame at {:.6g} s: the {} frames are from {:.6g} s to {:.6g} s",
                           file_.string(), time, n_frames(), first, last)};
}

std::optional<scene::Movie> TrajectorySource::movie_request() const { return plan_ ? plan_->movie : std::nullopt; }

Result<void> TrajectorySource::read_history() {
  constexpr std::size_t kMostPoints = 400;
  run::OrderCurve curve = SHAKEN_TRY(run::order_of_frames(reader_, kMostPoints));
  if (curve.times.empty()) return {};  // spheres have no S
  const double start = curve.times.front(), end = curve.times.back();
  history_ = {std::move(curve.times), std::move(curve.orders), start, end};
  return {};
}

std::vector<double> TrajectorySource::orders(double first, double last) const {
  std::vector<double> orders;
  for (std::size_t k = 0; k < history_.time.size(); ++k) {
    if (history_.time[k] >= first && history_.time[k] <= last) orders.push_back(history_.order[k]);
  }
  return orders;
}

Result<RodPicture> TrajectorySource::bare_picture(const Snapshot& frame, Asked asked) const {
  RodPicture picture;
  picture.cell = reader_.header().cell;
  static_cast<Snapshot&>(picture.frame) = frame;
  if (plan_) {
    const System& system = plan_->system;
    const PlateState plates = plates_->at(frame.tick);
    picture.frame.base = plates.base;
    if (system.has_lid_motion()) picture.frame.lid = plates.lid;
    picture.frame.has_lid = system.lid;
    const scene::MeasureDefects defects = plan_->defects.value_or(scene::MeasureDefects{});
    asked.smoothing = defects.smoothing;
    asked.grid = defects.grid;
  }
  SHAKEN_TRY(check_sizes(file_.string() + " has", picture, asked));
  const bool was_tracked = !reader_.header().lacking.empty();  // whose scene has other plates than the experiment
  const std::optional<double> gamma = plan_ && !was_tracked ? scene::gamma_of(plan_->system) : std::nullopt;
  picture.captions.settings = settings_of(picture);
  if (gamma) {
    picture.captions.settings.emplace_back("\u0393", fmt::format("{:.4g}", *gamma));
    picture.captions.settings.emplace_back("f", fmt::format("{:.4g} Hz", plan_->system.frequency));
  }
  name_runs({&picture.captions});
  measure(picture, asked);
  return picture;
}

Result<const std::vector<analysis::Defect>*> TrajectorySource::defects_of(std::size_t index) {
  if (const auto known = defects_.find(index); known != defects_.end()) return &known->second;
  const Snapshot frame = SHAKEN_TRY(reader_.frame(index));
  RodPicture picture = SHAKEN_TRY(bare_picture(frame, {.defects = true}));
  return &(defects_[index] = std::move(picture.found.defects));
}

Result<void> TrajectorySource::link(std::size_t first, std::size_t last) {
  if (!links_ || first < links_begin_ || first > links_end_) {
    const Cell& cell = reader_.header().cell;
    links_.emplace(analysis::Region(cell.box, cell.walls), cell.shapes.front().length());
    links_begin_ = links_end_ = first;
  }
  for (; links_end_ <= last; ++links_end_) {
    const double time = SHAKEN_TRY(time_of(links_end_));
    links_->add(time, *SHAKEN_TRY(defects_of(links_end_)));
  }
  return {};
}

Result<void> TrajectorySource::follow(const FollowedDefect& defect, std::size_t first, std::size_t last) {
  links_.reset();  // of these frames alone
  SHAKEN_TRY(link(first, last));
  followed_ = links_->longest(defect.charge, defect.rank);
  if (followed_) return {};
  return Error{fmt::format("view follow:{0}:{1} is of the {0} defect after {1} others: in these frames there are {2}",
                           defect.charge > 0 ? "plus" : "minus", defect.rank, links_->count(defect.charge))};
}

Result<std::vector<Vec2>> TrajectorySource::displacements(const Snapshot& now, std::size_t index, double span) const {
  if (!reader_.header().are_followed()) return Error{"no displacements: the rods were not followed"};
  const double recorded = SHAKEN_TRY(time_of(index));
  const std::size_t past = SHAKEN_TRY(nearest_frame(recorded - span));
  if (past == index && index > 0) {
    const double previous = SHAKEN_TRY(time_of(index - 1));
    return Error{
        fmt::format("no displacements over {:g} s: frames are recorded every {:g} s", span, recorded - previous)};
  }
  const Snapshot before = SHAKEN_TRY(reader_.frame(past));
  std::vector<Vec2> ways(now.n_rods(), Vec2::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t i = 0; i < now.n_rods(); ++i) {
    const std::optional<std::size_t> then = before.rod_of(now.track_of(i));
    if (then) ways[i] = (now.unwrapped(i) - before.unwrapped(*then)).head<2>();
  }
  return ways;
}

Result<RodPicture> TrajectorySource::picture(std::size_t index, const PictureStyle& style) {
  return picture_of(SHAKEN_TRY(reader_.frame(index)), index, style);
}

Result<RodPicture> TrajectorySource::picture_at(double time, const PictureStyle& style) {
  const std::size_t nearest = SHAKEN_TRY(nearest_frame(time));
  const double recorded = SHAKEN_TRY(time_of(nearest));
  constexpr double kSame = 1e-9;  // [s]
  const bool is_first = nearest == 0, is_last = nearest + 1 == n_frames();
  if (!style.interpolate || std::abs(time - recorded) < kSame || (is_first && time < recorded) ||
      (is_last && time > recorded)) {
    return picture(nearest, style);
  }
  const std::size_t first = time > recorded ? nearest : nearest - 1;
  const Snapshot before = SHAKEN_TRY(reader_.frame(first)), after = SHAKEN_TRY(reader_.frame(first + 1));
  if (before.track != after.track || !reader_.header().are_followed()) return picture(nearest, style);
  return picture_of(between(before, after, time, reader_.header().cell), first, style);
}

Result<RodPicture> TrajectorySource::picture_of(const Snapshot& frame, std::size_t index, const PictureStyle& style) {
  Asked asked = asked_by(style);
  const bool is_recorded = SHAKEN_TRY(time_of(index)) == frame.time;
  const auto known = is_recorded ? defects_.find(index) : defects_.end();
  if (known != defects_.end() && !asked.field) asked.defects = false;
  RodPicture picture = SHAKEN_TRY(bare_picture(frame, asked));
  if (known != defects_.end() && style.mark_defects) picture.found.defects = known->second;
  picture.captions.notes = notes_;
  if (followed_) picture.found.followed = followed_->at(picture.frame.time);
  if (style.displacements > 0) {
    picture.frame.displacement = SHAKEN_TRY(displacements(frame, index, style.displacements));
  }
  if (style.mark_defects && style.tracks > 0) {
    if (is_recorded) defects_[index] = picture.found.defects;
    std::size_t first = index;
    for (; first > 0; --first) {
      if (picture.frame.time - SHAKEN_TRY(time_of(first - 1)) > style.tracks) break;
    }
    SHAKEN_TRY(link(first, index));
    defects_.erase(defects_.begin(), defects_.lower_bound(first));  // a film does not go back
    picture.found.tracks = links_->trails(picture.frame.time, style.tracks);
  }
  if (history_.time.size() > 1) {
    picture.captions.history.start = history_.start;
    picture.captions.history.end = history_.end;
    for (std::size_t k = 0; k < history_.time.size() && history_.time[k] < picture.frame.time; ++k) {
      picture.captions.history.time.push_back(history_.time[k]);
      picture.captions.history.order.push_back(history_.order[k]);
    }
    picture.captions.history.time.push_back(picture.frame.time);
    picture.captions.history.order.push_back(picture.found.order);
  }
  return picture;
}

Result<RodPicture> live_picture(const std::string& lcm_url, const std::string& job, std::chrono::milliseconds timeout,
                                const PictureStyle& style) {
  const std::unique_ptr<proto::Bus> bus = SHAKEN_TRY(proto::Bus::open(lcm_url));
  // The unchanging part tells which job it is; only frames after it can be put together.
  std::optional<frame_static_t> constants;
  std::optional<proto::FrameAssembler> assembler;
  std::optional<proto::Frame> frame;
  StandingPosts posts;
  std::vector<std::uint8_t> species_of_shape;
  const auto note_constants = [&](const frame_static_t& message) {
    if (constants || !message.job_id.starts_with(job)) return;
    constants = message;
    assembler.emplace(message.job_id);
  };
  const auto note_posts = [&](const posts_t& message) {  // sent after the unchanging part, and before frames
    if (constants && message.job_id == constants->job_id) posts = proto::decode_posts(message);
  };
  const auto note_sizes = [&](const sizes_t& message) {  // likewise
    if (constants && message.job_id == constants->job_id) species_of_shape = message.species;
  };
  const auto note_chunk = [&](const frame_t& chunk) {
    if (assembler && !frame) frame = assembler->add(chunk);
  };
  if (!bus->subscribe<frame_static_t>(proto::kFrameStaticChannel, note_constants) ||
      !bus->subscribe<posts_t>(proto::kPostsChannel, note_posts) ||
      !bus->subscribe<sizes_t>(proto::kSizesChannel, note_sizes) ||
      !bus->subscribe<frame_t>(proto::kFrameChannel, note_chunk)) {
    return Error{"LCM refuses a subscription at " + lcm_url};
  }

  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + timeout;
  while (!frame) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) {
      return Error{
          fmt::format("no frame of job {} came within {} s at {}: is it running, with a \"stream\" block in its scene?",
                      job, timeout.count() / 1000, lcm_url)};
    }
    bus->handle(static_cast<int>(std::min<std::int64_t>(left.count(), 200)));
  }

  const Asked asked = asked_by(style);
  RodPicture picture;
  picture.frame.time = frame->sim_time_s;
  const std::optional<Cell> cell = proto::decode_cell(*constants);
  if (!cell) return Error{"the job's messages have numbers of beads that contradict each other"};
  picture.cell = *cell;
  picture.cell.posts = posts;
  picture.cell.species_of_shape = species_of_shape;
  picture.cell.box = frame->box;
  for (const proto::RodPose& rod : frame->rods) {
    const std::array<double, 3> axis = rod.axis();
    picture.frame.position.emplace_back(rod.x, rod.y, cell->gap / 2);
    picture.frame.director.emplace_back(axis[0], axis[1], axis[2]);
  }
  SHAKEN_TRY(check_sizes("the job's messages have", picture, asked));
  picture.captions.settings = settings_of(picture);
  name_runs({&picture.captions});
  if (!constants->label.empty()) {
    picture.captions.subtitle = picture.captions.label;
    picture.captions.label = headline(printable(constants->label));
  }
  picture.captions.notes = {{"Software", fmt::format("Shaken {}", run::version())},
                            {"Run id", printable(constants->job_id)}};
  measure(picture, asked);
  return picture;
}

}  // namespace shaken::render
