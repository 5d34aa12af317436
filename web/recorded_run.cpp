// SPDX-License-Identifier: MIT
#include "web/recorded_run.h"

#include <algorithm>
#include <limits>
#include <set>
#include <shaken/frame_static_t.hpp>
#include <system_error>

#include "analysis/order.h"
#include "client/watch/live_rods.h"
#include "run/files/directory.h"

namespace shaken::web {
namespace {

namespace fs = std::filesystem;

/// The same words for recorded rods as for live ones, so that both are checked and drawn alike.
frame_static_t static_part(const run::TrajectoryHeader& header) {
  frame_static_t message;
  message.utime = message.sequence = 0;
  message.sim_time_s = 0;
  message.n_rods = header.n_rods;
  message.box_side_mm = header.box_side;
  message.gap_mm = header.gap;
  const auto add = [&](const std::vector<double>& offset, const std::vector<double>& radius) {
    message.species_beads.push_back(static_cast<std::int32_t>(offset.size()));
    message.bead_offset_mm.insert(message.bead_offset_mm.end(), offset.begin(), offset.end());
    message.bead_radius_mm.insert(message.bead_radius_mm.end(), radius.begin(), radius.end());
  };
  add(header.bead_offset, header.bead_radius);
  for (const BeadRow& row : header.added_beads) add(row.offset, row.radius);
  message.n_species = static_cast<std::int32_t>(message.species_beads.size());
  message.n_beads = static_cast<std::int32_t>(message.bead_offset_mm.size());
  message.rod_species.assign(header.species_of_rod.begin(), header.species_of_rod.end());
  message.n_rod_species = static_cast<std::int32_t>(message.rod_species.size());
  message.arena = header.walls ? name_of(header.walls->arena) : "";
  message.arena_size_mm = header.walls ? header.walls->size : 0;
  message.arena_inner_mm = header.walls ? header.walls->inner : 0;
  return message;
}

}  // namespace

bool RecordedRuns::is_id(const std::string& text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

Result<const run::TrajectoryReader*> RecordedRuns::reader(const std::string& run) {
  const fs::path file = run::RunDirectory{directory(run)}.recorded();
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) return Error{"this run records no rods: its scene has no \"trajectory\" or \"movie\" block"};
  const auto written = fs::last_write_time(file, error).time_since_epoch().count();
  const std::string now = file.string() + " " + std::to_string(size) + " " + std::to_string(written);
  if (reader_ && opened_ == now) return &*reader_;
  reader_.reset();
  Result<run::TrajectoryReader> opened = run::TrajectoryReader::open(file);
  if (!opened) return opened.error();
  if (opened->n_frames() == 0) return Error{"no whole frame is recorded yet"};
  reader_.emplace(std::move(opened).value());
  opened_ = now;
  return &*reader_;
}

Result<RecordedRuns::Frames> RecordedRuns::frames(const std::string& run) {
  const std::lock_guard lock(mutex_);
  const auto reader = this->reader(run);
  if (!reader) return reader.error();
  const std::size_t n = (*reader)->n_frames();
  const auto first = (*reader)->recorded().frame(0), last = (*reader)->recorded().frame(n - 1);
  if (!first) return first.error();
  if (!last) return last.error();
  return Frames{n, first->time, last->time};
}

Result<client::RodFrame> RecordedRuns::frame(const std::string& run, std::size_t index) {
  const std::lock_guard lock(mutex_);
  const auto reader = this->reader(run);
  if (!reader) return reader.error();
  const Result<run::TrajectoryFrame> recorded = (*reader)->frame(index);
  if (!recorded) return recorded.error();
  std::optional<client::RodFrame> frame = client::constants_of(static_part((*reader)->header()));
  if (!frame) return Error{"the trajectory has sizes that no scene has"};
  frame->time = recorded->time;
  std::vector<Vec3> axes;  // of the first species, as in live messages
  for (std::size_t i = 0; i < recorded->position.size(); ++i) {
    const Vec3 &x = recorded->position[i], &n = recorded->director[i];
    frame->rods.push_back(proto::make_pose(x.x(), x.y(), {n.x(), n.y(), n.z()}));
    if (frame->species_of_rod.empty() || frame->species_of_rod[i] == 0) axes.push_back(n);
  }
  const analysis::NematicOrder mean = analysis::nematic_order(axes);
  frame->order = frame->has_axes() ? mean.order : std::numeric_limits<double>::quiet_NaN();
  frame->director = mean.director;
  return std::move(*frame);
}

Result<run::Observables> RecordedRuns::curves(const std::string& run) {
  const std::lock_guard lock(mutex_);
  const fs::path file = run::RunDirectory{directory(run)}.observables();
  std::error_code error;
  if (!fs::exists(file, error)) return Error{"there are no curves before the end of the run"};
  return run::read_observables(file);
}

std::vector<FileEntry> RecordedRuns::files(const std::string& run) const {
  std::vector<FileEntry> files;
  // what the program keeps for itself tells nobody anything
  const run::RunDirectory places{directory(run)};
  std::set<std::string> of_the_program{places.lock().filename().string()};
  for (const fs::path& checkpoint : places.checkpoints()) of_the_program.insert(checkpoint.filename().string());
  std::error_code error;
  for (fs::directory_iterator entry(directory(run), error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    const std::string name = entry->path().filename().string();
    if (of_the_program.contains(name)) continue;
    if (!entry->is_symlink(gone) && entry->is_regular_file(gone) && !gone) {
      files.push_back({name, entry->file_size(gone)});
    }
  }
  std::sort(files.begin(), files.end(), [](const FileEntry& a, const FileEntry& b) { return a.name < b.name; });
  return files;
}

}  // namespace shaken::web
