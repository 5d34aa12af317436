#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "base/descriptor.h"
#include "run/files/recorded_frame.h"
#include "run/files/recorded_frames.h"

namespace shaken::run {

/// trajectory.part: frames as they are recorded. The file only ever grows at its end, by records of one size that carry
/// their own hash: so a crash at any instant leaves every earlier frame as it was, and what comes after the last good
/// checkpoint is cut off by one ftruncate. HDF5 cannot promise that: an index that reaches the disk before the end of
/// the file does is a file that does not open. trajectory.h5 is made of it as a whole (write_trajectory).
///
/// Layout, little-endian: "SHKNFRAM"; version (u32); length of the header (u32); the header as JSON; its XXH3 (u64);
/// then for each frame tick (i64), time (f64), the arrays position, velocity, orientation and image of RecordedFrame
/// (f32, i32), and the XXH3 of all these (u64).
class FrameLog {
 public:
  /// A new file without frames, which takes the place of one that is there.
  static Result<FrameLog> create(const std::filesystem::path& file, const TrajectoryHeader& header);
  /// Opens a file to go on after its first `n_frames` frames. Fails, and leaves it as it is, unless they are all there
  /// and whole; what comes after them is cut off.
  static Result<FrameLog> reopen(const std::filesystem::path& file, std::size_t n_frames);

  /// Hands a frame to the operating system. If that fails, the file holds the frames from before.
  Result<void> append(const RecordedFrame& frame);
  /// Brings all frames to the disk.
  Result<void> sync() const;
  std::size_t n_frames() const { return n_frames_; }

 private:
  FrameLog(std::filesystem::path path, Descriptor file, std::size_t begin, std::size_t n_rods, std::size_t n_frames);
  std::size_t end() const;

  std::filesystem::path path_;
  Descriptor file_;
  std::size_t begin_;  ///< where the first frame begins [bytes]
  std::size_t n_rods_;
  std::size_t n_frames_;
};

/// Bytes of a frame in it.
std::size_t frame_bytes(std::size_t n_rods);
/// Reads trajectory.part, also while it grows: as many frames as were whole when it was opened.
Result<std::unique_ptr<RecordedFrames>> open_frame_log(const std::filesystem::path& file);
/// Whether the file says that it is one; the error where it cannot be read at the moment.
Result<bool> is_frame_log(const std::filesystem::path& file);

}  // namespace shaken::run
