#include "web/recorded_run.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "analysis/order.h"
#include "client/live/live_rods.h"

namespace shaken::web {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordsNone = "this run records no rods: its scene has no \"trajectory\" or \"movie\" block";

bool has_file(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

}  // namespace

Result<run::TrajectoryReader> RecordedRun::reader() const {
  const fs::path file = directory_.recorded();
  if (!has_file(file)) return Error{kRecordsNone};
  return run::TrajectoryReader::open(file);
}

Result<RecordedRun::Frames> RecordedRun::frames() const {
  if (!has_file(directory_.recorded())) return Frames{.reason = kRecordsNone};
  const auto reader = SHAKEN_TRY(this->reader());
  const std::size_t n = reader.n_frames();
  if (n == 0) return Frames{.reason = "no whole frame is recorded yet"};
  const auto first = SHAKEN_TRY(reader.recorded().frame(0)), last = SHAKEN_TRY(reader.recorded().frame(n - 1));
  return Frames{n, first.time, last.time};
}

Result<client::RodFrame> RecordedRun::frame(std::size_t index) const {
  const auto reader = SHAKEN_TRY(this->reader());
  const Snapshot recorded = SHAKEN_TRY(reader.frame(index));
  Result<client::RodFrame> frame = client::constants_of(reader.header().cell, recorded.position.size());
  if (!frame) return Error{"the trajectory has " + frame.error().message};
  frame->time = recorded.time;
  for (std::size_t i = 0; i < recorded.position.size(); ++i) {
    const Vec3 &x = recorded.position[i], &n = recorded.director[i];
    frame->heights.push_back(x.z());
    frame->rods.push_back(proto::make_pose(x.x(), x.y(), {n.x(), n.y(), n.z()}));
  }
  const analysis::NematicOrder mean = analysis::nematic_order(frame->cell, recorded.director);
  frame->order = mean.order;
  frame->director = mean.director;
  return frame;
}

Result<run::OrderCurve> RecordedRun::order(std::size_t most) const {
  return run::order_of_frames(SHAKEN_TRY(this->reader()), most);
}

Result<RecordedRun::Path> RecordedRun::path(std::size_t rod, std::size_t first, std::size_t last) const {
  const auto reader = SHAKEN_TRY(this->reader());
  if (!reader.header().are_followed()) return Error{"the rods were not followed"};
  const Snapshot shown = SHAKEN_TRY(reader.frame(last));
  if (rod >= shown.n_rods()) return Error{"there is no rod " + std::to_string(rod)};
  Path path;
  for (std::size_t k = first; k <= last; ++k) {
    const Snapshot recorded = SHAKEN_TRY(reader.frame(k));
    const std::optional<std::size_t> there = recorded.rod_of(shown.track_of(rod));
    if (!there) continue;  // it was missed
    path.times.push_back(recorded.time);
    path.x.push_back(recorded.position[*there].x());
    path.y.push_back(recorded.position[*there].y());
    path.n_z.push_back(recorded.director[*there].z());
  }
  return path;
}

Result<run::Observables> RecordedRun::curves() const {
  if (!has_file(directory_.observables())) return Error{"there are no curves before the end of the run"};
  return run::read_observables(directory_.observables());
}

std::vector<FileEntry> RecordedRun::files() const {
  std::vector<FileEntry> files;
  // what the program keeps for itself tells nobody anything
  std::set<std::string> of_the_program{directory_.lock().filename().string()};
  for (const fs::path& checkpoint : directory_.checkpoints()) of_the_program.insert(checkpoint.filename().string());
  std::error_code error;
  for (fs::directory_iterator entry(directory_.root, error), end; !error && entry != end; entry.increment(error)) {
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
