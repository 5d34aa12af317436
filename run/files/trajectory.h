#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/core/result.h"
#include "run/files/directory.h"
#include "run/files/frame_log.h"
#include "run/files/recorded_frames.h"

namespace shaken::run {

/// Writes trajectory.h5 in H5MD (de Buyl, Colberg, Hoefling 2014): /particles/trajectory/{position, image, velocity,
/// orientation, box}, where orientation is the unit quaternion (w, x, y, z) that turns z into the director; with
/// several species also H5MD's fixed element `species`, the species of each rod from 0, whose beads stand in
/// /parameters and /parameters/species_2, species_3; where rods of a species differ in size, the beads of shape k stand
/// in /parameters/shape_k, and `shape` is that of each rod. Side walls are the attributes of /parameters/walls; where
/// posts stand is in /parameters/posts. Units are those of H5MD's module "units", in the attribute `unit` of each data
/// set (docs/files.md). Chunks carry checksums. The file is written as a whole: a crash leaves the former one, or none.
Result<void> write_trajectory(const std::filesystem::path& file, const RecordedFrames& frames);
/// The same with another header of the same rods, where the run has come to know better than the frames' own.
Result<void> write_trajectory(const std::filesystem::path& file, const TrajectoryHeader& header,
                              const RecordedFrames& frames);

/// The log of a run of which `n_frames` frames are recorded, to go on after these; made anew of trajectory.h5 where
/// there is no log. Fails unless all of them are there and whole, and then changes nothing.
Result<FrameLog> reopen_frames(const RunDirectory& directory, std::size_t n_frames);

/// Whether a file is one of these two kinds, whole or not; what is neither may be a table.
bool is_trajectory(const std::filesystem::path& file);

/// Frames of a trajectory.h5, or of a trajectory.part, also while that is being written.
class TrajectoryReader {
 public:
  /// A trajectory.h5 that is not what the run has written is refused before HDF5 reads it (run/files/content_hash.h).
  static Result<TrajectoryReader> open(const std::filesystem::path& file);
  const TrajectoryHeader& header() const { return frames_->header(); }
  std::size_t n_frames() const { return frames_->n_frames(); }
  Result<Snapshot> frame(std::size_t index) const;
  const RecordedFrames& recorded() const { return *frames_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  TrajectoryReader(std::filesystem::path path, std::unique_ptr<RecordedFrames> frames)
      : path_(std::move(path)), frames_(std::move(frames)) {}
  std::filesystem::path path_;
  std::unique_ptr<RecordedFrames> frames_;
};

}  // namespace shaken::run
