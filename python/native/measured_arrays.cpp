#include "python/native/measured_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/keys/problem.h"
#include "base/text.h"
#include "run/files/recorded_frames.h"
#include "run/loop/open_run.h"
#include "run/recorded/measure_frames.h"
#include "run/recorded/tracks.h"
#include "scene/canonical.h"
#include "sim/motion/side_walls.h"
#include "sim/world.h"

namespace shaken::python {
namespace {

/// Fails with what no rod of the box can have.
Result<void> check(const Snapshot& frame, std::size_t number, const Box& box) {
  constexpr double kEqual = 1e-5;  // sides of files in single precision
  if (frame.box.x() > 0 && !frame.box.sides().isApprox(box.sides(), kEqual)) {
    return Error{
        fmt::format("frame {} is of a box of {:.6g} by {:.6g} mm, and the scene has one of {:.6g} by {:.6g} mm", number,
                    frame.box.x(), frame.box.y(), box.x(), box.y())};
  }
  for (std::size_t i = 0; i < frame.n_rods(); ++i) {
    const Vec3& at = frame.position[i];
    const bool is_near = (at.head<2>().array().abs() <= run::kMostBoxes * box.shorter()).all();
    if (is_near && !std::isinf(at.z()) && frame.director[i].allFinite() && frame.velocity[i].allFinite()) continue;
    return Error{
        fmt::format("frame {}, rod {}: a number is none, or lies too far from the box", number, frame.track_of(i))};
  }
  return {};
}

/// Leaves out the rods that have no position. Others that are followed keep their numbers.
void leave_out_missed(Snapshot& frame, bool is_followed) {
  Snapshot seen;
  seen.box = frame.box;
  for (std::size_t i = 0; i < frame.n_rods(); ++i) {
    if (frame.position[i].head<2>().hasNaN()) continue;
    seen.track.push_back(static_cast<std::uint32_t>(is_followed ? i : seen.track.size()));
    seen.position.push_back(frame.position[i]);
    seen.director.push_back(frame.director[i]);
    seen.velocity.push_back(frame.velocity[i]);
    if (!frame.image.empty()) seen.image.push_back(frame.image[i]);
  }
  seen.n_tracks = frame.n_rods();
  frame = std::move(seen);
}

}  // namespace

Result<Measured> measure_arrays(const Scene& scene, std::vector<Snapshot> frames, double interval, run::Lacking lacking,
                                bool is_tracked, const GoOn& go_on) {
  const std::string started = utc_now();
  scene::RunPlan asked = SHAKEN_TRY(resolved(scene));
  asked.system.added = {};  // frames are of the first species alone
  const bool is_followed = !lacking.contains(run::Needs::kIdentities);
  std::size_t n_all = 0, n_tracks = 0;
  for (Snapshot& frame : frames) {
    n_tracks = std::max(n_tracks, frame.n_rods());
    leave_out_missed(frame, is_followed);
    if (frame.n_rods() == 0) return Error{fmt::format("frame {} has no rod", &frame - frames.data())};
    n_all += frame.n_rods();
  }
  const bool is_complete = is_followed && n_all == n_tracks * frames.size();
  if (!is_complete) lacking.insert(run::Needs::kEveryRod);
  const std::size_t mean =
      frames.empty()
          ? 0
          : static_cast<std::size_t>(std::llround(static_cast<double>(n_all) / static_cast<double>(frames.size())));
  const auto own = run::plan_of_tracks(asked, "scene", {{std::max<std::size_t>(mean, 1)}, frames.size(), interval});
  if (!own) return as_error(own.error());

  const Tick spacing = run::ticks_between(interval, asked);
  const Vec2 period = period_of(own->system.box(), own->system.walls);
  std::vector<run::LastSeen> last(is_followed ? n_tracks : 0);
  std::size_t number = 0;
  for (Snapshot& frame : frames) {
    SHAKEN_TRY(check(frame, number, own->system.box()));
    frame.tick = spacing * static_cast<Tick>(number++);
    frame.time = static_cast<double>(frame.tick) * own->system.dt;
    frame.box = own->system.box();
    for (Vec3& at : frame.position) at.z() = std::isnan(at.z()) ? own->system.gap / 2 : at.z();
    if (frame.image.empty()) run::fold_into_box(frame, period, last);
  }
  std::vector<std::string> remarks;
  const bool is_without = is_complete && frames.size() > 1 && lacking.erase(run::Needs::kVelocities) > 0;
  if (is_without) run::set_velocities(frames, interval);
  if (is_without || (is_tracked && !lacking.contains(run::Needs::kVelocities)))
    remarks.push_back(run::remark_on_velocities(frames.size(), interval));
  std::vector<run::RecordedFrame> recorded;
  recorded.reserve(frames.size());
  for (const Snapshot& frame : frames) recorded.push_back(run::record(frame));
  const std::string text = scene::to_json(*own).dump(2) + "\n";
  run::TrajectoryHeader header = run::trajectory_header(empty_world(own->system), text, {});
  header.n_rods = static_cast<int>(n_tracks);
  header.lacking = run::words_of(lacking);
  const run::FramesInMemory memory(std::move(header), std::move(recorded));
  auto by = run::plan_for_frames({text, "scene"}, {text, "scene"}, {}, spacing, lacking);
  if (!by) return as_error(by.error());
  by->remarks.insert(by->remarks.begin(), remarks.begin(), remarks.end());
  const Result<run::MeasuredFrames> found =
      run::measure_frames(by->plan, memory, [&](std::size_t) { return !go_on || go_on(); });
  if (!found) return found.error();
  run::Summary summary = run::summary_of(*by, *found, "arrays");
  summary.started = started;
  summary.finished = utc_now();
  return Measured{scene::to_json(by->plan).dump(), run::summary_text(summary), found->reduction.arrays};
}

}  // namespace shaken::python
