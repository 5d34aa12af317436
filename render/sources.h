#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/result.h"
#include "render/defect_links.h"
#include "render/picture.h"
#include "render/style.h"
#include "run/files/trajectory.h"
#include "scene/keys/run_plan.h"
#include "sim/motion/plates.h"

namespace shaken::render {

/// The rods at a time between two recorded frames of one run, for films that are slower than the recording: centres go
/// straight from one place to the other, across borders too, and axes turn the shorter way; rods that are the same fore
/// and aft by less than a right angle. A rod that comes farther than its length in between, or turns by more than 60
/// degrees, has been hit too often for that: it stays as the nearer frame has it.
Snapshot between(const Snapshot& before, const Snapshot& after, double time, const Cell& cell);

/// The frames of a recorded run. For one thread at a time.
class TrajectorySource {
 public:
  /// Opens a run directory or a trajectory.h5. Fails if it holds no frame.
  static Result<TrajectorySource> open(const std::filesystem::path& run_or_file);

  /// The file that is read.
  const std::filesystem::path& file() const { return file_; }
  std::size_t n_frames() const { return reader_.n_frames(); }
  /// Simulated time of a frame [s].
  Result<double> time_of(std::size_t index) const;
  /// What the run says of itself: its id, seed, and the versions of Shaken and of its physics, as far as it is known.
  const Notes& notes() const { return notes_; }
  /// The frame nearest to `time` [s].
  Result<std::size_t> nearest_frame(double time) const;

  /// The same, unless `time` is before the first frame or after the last one by more than they are apart: then an error
  /// that says what is recorded.
  Result<std::size_t> recorded_frame(double time) const;

  /// What the scene asks for; none if it has no such block.
  std::optional<scene::Movie> movie_request() const;

  /// Reads S(t) of the whole run, from at most 400 of its frames, for the curve beside the pictures.
  Result<void> read_history();
  /// S of the frames from `first` to `last` that read_history() has read; empty if it has not.
  std::vector<double> orders(double first, double last) const;
  /// Pictures from now on say where the defect is that lives longest in the recorded frames from `first` to `last`
  /// (DefectLinks::longest). Fails if there are not so many.
  Result<void> follow(const FollowedDefect& defect, std::size_t first, std::size_t last);
  /// A frame with order, director and what the style asks for; with S up to its time if the history has been read.
  Result<RodPicture> picture(std::size_t index, const PictureStyle& style);
  /// The same at any time [s]: of the nearest frame or, if the style interpolates, between() two. Before the first
  /// frame and after the last one it is that frame's.
  Result<RodPicture> picture_at(double time, const PictureStyle& style);

 private:
  TrajectorySource(std::filesystem::path file, run::TrajectoryReader reader)
      : file_(std::move(file)), reader_(std::move(reader)) {}
  std::filesystem::path file_;
  run::TrajectoryReader reader_;
  std::optional<scene::RunPlan> plan_;  ///< of the scene, if it is one
  std::optional<PlateMotion> plates_;   ///< of that
  Notes notes_;
  /// Has the defects of the frames from `first` to `last` linked, and of those before that are linked already.
  Result<void> link(std::size_t first, std::size_t last);
  /// The defects of a frame, kept for the tracks of later ones.
  Result<const std::vector<analysis::Defect>*> defects_of(std::size_t index);
  /// How far each rod has come, from the frame nearest to `span` seconds before the one of `index`, to `now`.
  Result<std::vector<Vec2>> displacements(const Snapshot& now, std::size_t index, double span) const;
  Result<RodPicture> bare_picture(const Snapshot& frame, Asked asked) const;
  /// The picture of a frame at, or next to, the recorded one of `index`.
  Result<RodPicture> picture_of(const Snapshot& frame, std::size_t index, const PictureStyle& style);

  OrderHistory history_;
  mutable std::map<std::size_t, double> times_;
  std::map<std::size_t, std::vector<analysis::Defect>> defects_;
  std::optional<DefectLinks> links_;
  std::size_t links_begin_ = 0, links_end_ = 0;  // the frames that are linked
  std::optional<DefectLife> followed_;
};

/// The next whole frame that a running job sends over LCM. `job` is its id or the beginning of it. The bus carries no
/// heights: rods lie half way between the plates.
Result<RodPicture> live_picture(const std::string& lcm_url, const std::string& job, std::chrono::milliseconds timeout,
                                const PictureStyle& style);

}  // namespace shaken::render
