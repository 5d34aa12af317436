// SPDX-License-Identifier: MIT
#include "render/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <shaken/frame_static_t.hpp>
#include <shaken/frame_t.hpp>

#include "analysis/director_field.h"
#include "analysis/order.h"
#include "base/files.h"
#include "base/text.h"
#include "proto/bus.h"
#include "proto/channels.h"
#include "proto/frame_codec.h"
#include "render/colourings.h"
#include "render/headline.h"
#include "run/files/directory.h"
#include "run/files/version.h"
#include "scene/fields.h"
#include "scene/measure_plan.h"

namespace shaken::render {

namespace {

using Json = nlohmann::json;

/// A number of the resolved scene, whose values are in default units.
std::optional<double> number_at(const Json& scene, const char* pointer) {
  const Json::json_pointer place(pointer);
  if (!scene.contains(place) || !scene.at(place).is_number()) return std::nullopt;
  const double value = scene.at(place).get<double>();
  return std::abs(value) < 1e9 ? std::optional(value) : std::nullopt;  // no scene has more
}

std::string shaking(const Json& scene) {
  const std::optional<double> gamma = number_at(scene, "/plates/gamma"),
                              frequency = number_at(scene, "/plates/frequency");
  return gamma && frequency ? fmt::format("\u0393 = {:.4g}, f = {:.4g} Hz", *gamma, *frequency) : "";
}

std::optional<SideWalls> walls_of(const frame_static_t& message) {
  const std::optional<Arena> arena = arena_of(message.arena);
  if (!arena) return std::nullopt;
  SideWalls walls;
  walls.arena = *arena;
  walls.size = message.arena_size_mm;
  walls.inner = message.arena_inner_mm;
  return walls;
}

/// Nothing if `value` is one that a scene may have at `path`, or half of one; else what is wrong.
Result<void> refusal(const std::string& who, const char* what, double value, const char* path, double share = 1) {
  constexpr double kRounding = 1e-9;
  const scene::Field& field = scene::field_at(path);
  const double low = share * field.low, high = share * field.high;
  if (value >= low * (1 - kRounding) && value <= high * (1 + kRounding)) return {};  // false for NaN
  return Error{fmt::format("{} a {} of {} mm; a scene has {} to {} mm", who, what, value, low, high)};
}

/// The sizes of a picture whose source `who` tells ("the job's messages have"). Anybody may send messages, and files
/// may be damaged: what no scene has would take any memory and any time.
Result<void> check_sizes(const std::string& who, const RodPicture& picture, const Asked& asked) {
  // Of the director field, in each direction: 0.7 GB. The largest box with rods of 4 mm needs as many.
  constexpr double kMostNodes = 4096;
  if (auto done = refusal(who, "box side", picture.box_side, "box.side"); !done) return done.error();
  if (auto done = refusal(who, "gap", picture.gap, "box.gap"); !done) return done.error();
  for (std::size_t species = 0; species < picture.n_species(); ++species) {
    const BeadRow& beads = picture.beads_of(species);
    for (const double radius : beads.radius) {
      if (auto done = refusal(who, "bead radius", radius, "rods.bead_diameters", 0.5); !done) return done.error();
    }
    for (const double offset : beads.offset) {
      // Beads may lie anywhere along a rod, so the shortest rod does not matter.
      const double half = std::max(std::abs(offset), scene::field_at("rods.length").low / 2);
      if (auto done = refusal(who, "bead offset", std::isnan(offset) ? offset : half, "rods.length", 0.5); !done)
        return done.error();
    }
  }
  if (picture.walls) {
    if (auto done = refusal(who, "arena", picture.walls->size, "walls.size"); !done) return done.error();
    if (picture.walls->arena == Arena::kAnnulus) {
      if (auto done = refusal(who, "inner wall", picture.walls->inner, "walls.inner"); !done) return done.error();
    }
  }
  const double mesh = picture.grid > 0 ? picture.grid : scene::MeasureDefects{}.grid_for(picture.rod_length());
  if ((asked.defects || asked.field) && picture.box_side / mesh > kMostNodes) {
    return Error{
        fmt::format("a box of {} mm is too large for a picture of rods of {} mm with defects on this mesh (at most {} "
                    "nodes each way); draw it without them",
                    picture.box_side, picture.rod_length(), kMostNodes)};
  }
  return {};
}

/// Species and side walls out of a message, whose counts need not agree.
Result<void> take_constants(const frame_static_t& message, std::size_t n_rods, RodPicture& picture) {
  const Error garbled{"the job's static part contradicts itself"};
  std::vector<BeadRow> rows;
  std::size_t begin = 0;
  for (const std::int32_t n : message.species_beads) {
    if (n < 1 || static_cast<std::size_t>(n) > message.bead_offset_mm.size() - begin) return garbled;
    const auto piece = [&](const std::vector<double>& all) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
      return std::vector<double>(first, first + n);
    };
    rows.push_back({piece(message.bead_offset_mm), piece(message.bead_radius_mm)});
    begin += static_cast<std::size_t>(n);
  }
  if (rows.empty() || begin != message.bead_offset_mm.size()) return garbled;
  if (message.rod_species.size() != (rows.size() > 1 ? n_rods : 0)) return garbled;
  if (std::any_of(message.rod_species.begin(), message.rod_species.end(),
                  [&](std::uint8_t kind) { return kind >= rows.size(); })) {
    return garbled;
  }
  picture.beads = rows.front();
  picture.added.assign(rows.begin() + 1, rows.end());
  picture.species_of_rod = message.rod_species;
  picture.walls = walls_of(message);
  return {};
}

}  // namespace

Result<TrajectorySource> TrajectorySource::open(const std::filesystem::path& run_or_file) {
  std::error_code ignored;
  const std::filesystem::path file =
      std::filesystem::is_directory(run_or_file, ignored) ? run::RunDirectory{run_or_file}.recorded() : run_or_file;
  if (!std::filesystem::exists(file, ignored)) {
    return Error{"there is no " + file.string() +
                 ": give a run directory or its trajectory.h5, of a scene with a \"trajectory\" or \"movie\" block"};
  }
  Result<run::TrajectoryReader> reader = run::TrajectoryReader::open(file);
  if (!reader) return reader.error();
  if (reader->n_frames() == 0) return Error{file.string() + " holds no complete frame yet"};
  return TrajectorySource(file, std::move(*reader));
}

Result<double> TrajectorySource::time_of(std::size_t index) const {
  if (const auto known = times_.find(index); known != times_.end()) return known->second;
  const Result<run::TrajectoryFrame> frame = reader_.frame(index);
  if (!frame) return frame.error();
  times_[index] = frame->time;
  return frame->time;
}

std::string TrajectorySource::label() const {
  return shaking(Json::parse(reader_.header().scene_json, nullptr, false));
}

Notes TrajectorySource::notes() const {
  const run::Provenance& run = reader_.header().provenance;
  Notes notes{{"Software", fmt::format("Shaken {}", run::version())}};
  if (!run.run_id.empty()) {
    notes.emplace_back("Run id", run.run_id);
    notes.emplace_back("Seed", fmt::format("{}", run.seed));
  }
  // The versions that the run was made with, which need not be those of this program.
  const Result<std::string> text = read_file(file_.parent_path() / "summary.json");
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

Result<std::size_t> TrajectorySource::nearest_frame(double time) const {
  // First frame at or after `time`, by bisection.
  std::size_t low = 0, high = n_frames();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const Result<double> at = time_of(middle);
    if (!at) return at.error();
    if (*at < time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low == n_frames()) return low - 1;
  if (low == 0) return low;
  const Result<double> before = time_of(low - 1), after = time_of(low);
  if (!before) return before.error();
  if (!after) return after.error();
  return time - *before <= *after - time ? low - 1 : low;
}

Result<std::size_t> TrajectorySource::recorded_frame(double time) const {
  const Result<double> first = time_of(0), last = time_of(n_frames() - 1);
  if (!first) return first.error();
  if (!last) return last.error();
  const double apart = n_frames() > 1 ? (*last - *first) / static_cast<double>(n_frames() - 1) : 1e-3;
  if (time >= *first - apart && time <= *last + apart) return nearest_frame(time);
  return Error{fmt::format("{}: there is no frame at {:.6g} s: the {} frames are from {:.6g} s to {:.6g} s",
                           file_.string(), time, n_frames(), *first, *last)};
}

std::optional<MovieRequest> TrajectorySource::movie_request() const {
  const Json scene = Json::parse(reader_.header().scene_json, nullptr, false);
  const std::optional<double> every = number_at(scene, "/movie/every"), width = number_at(scene, "/movie/size/0"),
                              height = number_at(scene, "/movie/size/1");
  if (!every || !width || !height) return std::nullopt;
  return MovieRequest{*every, static_cast<int>(*width), static_cast<int>(*height)};
}

Result<void> TrajectorySource::read_history() {
  if (reader_.header().bead_offset.size() < 2) return {};  // spheres have no S
  constexpr std::size_t kMostPoints = 400;
  const std::size_t last = n_frames() - 1, points = std::min(kMostPoints, last + 1);
  OrderHistory history;
  const std::vector<std::uint8_t>& species_of_rod = reader_.header().species_of_rod;
  for (std::size_t k = 0; k < points; ++k) {
    const Result<run::TrajectoryFrame> frame = reader_.frame(points == 1 ? last : k * last / (points - 1));
    if (!frame) return frame.error();
    history.time.push_back(frame->time);
    std::vector<Vec3> directors;  // of rods of the first species
    for (std::size_t i = 0; i < frame->director.size(); ++i) {
      if (species_of_rod.empty() || species_of_rod[i] == 0) directors.push_back(frame->director[i]);
    }
    history.order.push_back(analysis::nematic_order(directors).order);
  }
  history.start = history.time.front();
  history.end = history.time.back();
  history_ = std::move(history);
  return {};
}

std::vector<double> TrajectorySource::orders(double first, double last) const {
  std::vector<double> orders;
  for (std::size_t k = 0; k < history_.time.size(); ++k) {
    if (history_.time[k] >= first && history_.time[k] <= last) orders.push_back(history_.order[k]);
  }
  return orders;
}

Result<RodPicture> TrajectorySource::bare_picture(std::size_t index, const Asked& asked) const {
  Result<run::TrajectoryFrame> frame = reader_.frame(index);
  if (!frame) return frame.error();
  const run::TrajectoryHeader& header = reader_.header();
  RodPicture picture;
  picture.time = frame->time;
  picture.box_side = header.box_side;
  picture.gap = header.gap;
  const Json scene = Json::parse(header.scene_json, nullptr, false);
  picture.label = shaking(scene);
  // z_base = a cos(2 pi f t) + a (sim/motion/plates.h)
  const double amplitude = number_at(scene, "/plates/amplitude").value_or(0),
               frequency = number_at(scene, "/plates/frequency").value_or(0);
  picture.base = amplitude * (1 + std::cos(2 * kPi * frequency * picture.time));
  const Json::json_pointer lid("/plates/lid");
  picture.has_lid = !scene.is_object() || !scene.contains(lid) || scene.at(lid) != false;
  picture.beads = {header.bead_offset, header.bead_radius};
  picture.added = header.added_beads;
  picture.species_of_rod = header.species_of_rod;
  picture.walls = header.walls;
  picture.smoothing = number_at(scene, "/measure/defects/smoothing").value_or(0);
  picture.grid = number_at(scene, "/measure/defects/grid").value_or(0);
  picture.position = std::move(frame->position);
  picture.director = std::move(frame->director);
  picture.velocity = std::move(frame->velocity);
  if (auto done = check_sizes(file_.string() + " has", picture, asked); !done) return done.error();
  measure(picture, asked);
  return picture;
}

Result<const std::vector<analysis::Defect>*> TrajectorySource::defects_of(std::size_t index) {
  if (const auto known = defects_.find(index); known != defects_.end()) return &known->second;
  Result<RodPicture> picture = bare_picture(index, {.defects = true});
  if (!picture) return picture.error();
  return &(defects_[index] = std::move(picture->defects));
}

Result<void> TrajectorySource::link(std::size_t first, std::size_t last) {
  if (!links_ || first < links_begin_ || first > links_end_) {
    const run::TrajectoryHeader& header = reader_.header();
    RodPicture rods;
    rods.beads = {header.bead_offset, header.bead_radius};
    links_.emplace(analysis::Region(header.box_side, header.walls), rods.rod_length());
    links_begin_ = links_end_ = first;
  }
  for (; links_end_ <= last; ++links_end_) {
    const Result<double> time = time_of(links_end_);
    if (!time) return time.error();
    const auto defects = defects_of(links_end_);
    if (!defects) return defects.error();
    links_->add(*time, **defects);
  }
  return {};
}

Result<void> TrajectorySource::follow(const FollowedDefect& defect, std::size_t first, std::size_t last) {
  links_.reset();  // of these frames alone
  if (auto done = link(first, last); !done) return done.error();
  followed_ = links_->longest(defect.charge, defect.rank);
  if (followed_) return {};
  return Error{fmt::format("view follow:{0}:{1} is of the {0} defect after {1} others: in these frames there are {2}",
                           defect.charge > 0 ? "plus" : "minus", defect.rank, links_->count(defect.charge))};
}

Result<std::vector<Vec2>> TrajectorySource::displacements(std::size_t index, double span) const {
  const Result<run::TrajectoryFrame> now = reader_.frame(index);
  if (!now) return now.error();
  const Result<std::size_t> past = nearest_frame(now->time - span);
  if (!past) return past.error();
  if (*past == index && index > 0) {
    const Result<double> previous = time_of(index - 1);
    if (!previous) return previous.error();
    return Error{
        fmt::format("no displacements over {:g} s: frames are recorded every {:g} s", span, now->time - *previous)};
  }
  const Result<run::TrajectoryFrame> before = reader_.frame(*past);
  if (!before) return before.error();
  const auto unwrapped = [&](const run::TrajectoryFrame& frame, std::size_t i) -> Vec2 {
    return frame.position[i].head<2>() + reader_.header().box_side * Vec2(frame.image[i][0], frame.image[i][1]);
  };
  std::vector<Vec2> ways;
  for (std::size_t i = 0; i < now->position.size(); ++i) ways.emplace_back(unwrapped(*now, i) - unwrapped(*before, i));
  return ways;
}

Result<RodPicture> TrajectorySource::picture(std::size_t index, const PictureStyle& style) {
  Asked asked = asked_by(style);
  const auto known = defects_.find(index);
  if (known != defects_.end() && !asked.field) asked.defects = false;
  Result<RodPicture> made = bare_picture(index, asked);
  if (!made) return made.error();
  RodPicture& picture = *made;
  if (known != defects_.end() && style.mark_defects) picture.defects = known->second;
  picture.notes = notes();
  if (followed_) picture.followed = followed_->at(picture.time);
  if (style.displacements > 0) {
    Result<std::vector<Vec2>> ways = displacements(index, style.displacements);
    if (!ways) return ways.error();
    picture.displacement = std::move(*ways);
  }
  if (style.mark_defects && style.tracks > 0) {
    defects_[index] = picture.defects;
    std::size_t first = index;
    for (; first > 0; --first) {
      const Result<double> before = time_of(first - 1);
      if (!before) return before.error();
      if (picture.time - *before > style.tracks) break;
    }
    if (auto done = link(first, index); !done) return done.error();
    defects_.erase(defects_.begin(), defects_.lower_bound(first));  // a film does not go back
    picture.tracks = links_->trails(picture.time, style.tracks);
  }
  if (history_.time.size() > 1) {
    picture.history.start = history_.start;
    picture.history.end = history_.end;
    for (std::size_t k = 0; k < history_.time.size() && history_.time[k] < picture.time; ++k) {
      picture.history.time.push_back(history_.time[k]);
      picture.history.order.push_back(history_.order[k]);
    }
    picture.history.time.push_back(picture.time);
    picture.history.order.push_back(picture.order);
  }
  return made;
}

Result<RodPicture> live_picture(const std::string& lcm_url, const std::string& job, std::chrono::milliseconds timeout,
                                const PictureStyle& style) {
  const Result<std::unique_ptr<proto::Bus>> opened = proto::Bus::open(lcm_url);
  if (!opened) return opened.error();
  proto::Bus& bus = **opened;
  // The unchanging part tells which job it is; only frames after it can be put together.
  std::optional<frame_static_t> constants;
  std::optional<proto::FrameAssembler> assembler;
  std::optional<proto::Frame> frame;
  const auto note_constants = [&](const frame_static_t& message) {
    if (constants || !message.job_id.starts_with(job)) return;
    constants = message;
    assembler.emplace(message.job_id);
  };
  const auto note_chunk = [&](const frame_t& chunk) {
    if (assembler && !frame) frame = assembler->add(chunk);
  };
  if (!bus.subscribe<frame_static_t>(proto::kFrameStaticChannel, note_constants) ||
      !bus.subscribe<frame_t>(proto::kFrameChannel, note_chunk)) {
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
    bus.handle(static_cast<int>(std::min<std::int64_t>(left.count(), 200)));
  }

  const Asked asked = asked_by(style);
  RodPicture picture;
  picture.time = frame->sim_time_s;
  picture.box_side = frame->box_side_mm;
  picture.gap = constants->gap_mm;
  if (auto done = take_constants(*constants, frame->rods.size(), picture); !done) return done.error();
  if (auto done = check_sizes("the job's messages have", picture, asked); !done) return done.error();
  picture.label = headline(printable(constants->label));
  picture.notes = {{"Software", fmt::format("Shaken {}", run::version())}, {"Run id", printable(constants->job_id)}};
  for (const proto::RodPose& rod : frame->rods) {
    const std::array<double, 3> axis = rod.axis();
    picture.position.emplace_back(rod.x, rod.y, picture.gap / 2);
    picture.director.emplace_back(axis[0], axis[1], axis[2]);
  }
  measure(picture, asked);
  return picture;
}

}  // namespace shaken::render
