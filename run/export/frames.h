#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "base/core/result.h"
#include "run/export/frame_format.h"
#include "run/files/trajectory.h"

namespace shaken::run {

/// Which frames of a trajectory are wanted.
struct WantedFrames {
  std::optional<double> from{};  ///< none earlier than this [s]
  std::optional<double> to{};    ///< none later [s]
  std::size_t every = 1;         ///< of those, the first and every so many after it
  bool only_last = false;        ///< of those, the last
};

/// Frames first, first + every ... below `end`.
struct FrameRange {
  std::size_t first = 0;
  std::size_t end = 0;
  std::size_t every = 1;

  std::size_t size() const { return end <= first ? 0 : (end - first - 1) / every + 1; }
};

/// Times are compared by whole ticks, so that 0.2 s finds the frame of tick 0.2 s / dt. Reads a few frames to find
/// their places. Fails if there is no such frame, and says from when to when there are frames.
Result<FrameRange> find_frames(const TrajectoryReader& trajectory, const WantedFrames& wanted);

/// Hands the frames of `range` to `format`, one after the other. After each, `goes_on` is asked with the number of
/// those that are done; false ends it. Returns that number, or why a frame could not be read or written.
Result<std::size_t> export_frames(const TrajectoryReader& trajectory, const FrameRange& range, FrameFormat& format,
                                  const Sink& sink, const std::function<bool(std::size_t n_done)>& goes_on);

}  // namespace shaken::run
