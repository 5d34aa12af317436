#pragma once

#include <utility>
#include <vector>

#include "run/files/recorded_frames.h"

namespace shaken::run {

/// Frames that come from no file, or are not there yet.
class FramesInMemory final : public RecordedFrames {
 public:
  FramesInMemory(TrajectoryHeader header, std::vector<RecordedFrame> frames)
      : header_(std::move(header)), frames_(std::move(frames)) {}
  const TrajectoryHeader& header() const override { return header_; }
  std::size_t n_frames() const override { return frames_.size(); }
  Result<RecordedFrame> frame(std::size_t index) const override { return frames_[index]; }

 private:
  TrajectoryHeader header_;
  std::vector<RecordedFrame> frames_;
};

}  // namespace shaken::run
