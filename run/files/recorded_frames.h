#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "run/files/provenance.h"
#include "run/files/recorded_frame.h"
#include "sim/cell.h"

namespace shaken::run {

/// What tracked rods lack where nobody knows which rod of one frame is which of another.
inline constexpr const char* kFollowedRods = "rods that are followed from frame to frame";

/// What does not change along a trajectory, and what drawing it needs.
struct TrajectoryHeader {
  int n_rods = 0;
  Cell cell{};
  double dt = 0;             ///< [s]
  std::string scene_json{};  ///< the resolved scene
  Provenance provenance{};
  std::string lacking{};  ///< of rods that were tracked: what nobody has seen, in words (run/measure: words_of)

  /// Whether a rod of one frame is known in others, so that paths and displacements mean something.
  bool are_followed() const { return lacking.find(kFollowedRods) == std::string::npos; }
};

/// Nothing if a scene may have such rods (scene/keys/cell_limits.h); else what is wrong.
Result<void> check(const TrajectoryHeader& header);

/// Frames in a file of either kind.
class RecordedFrames {
 public:
  virtual ~RecordedFrames() = default;
  virtual const TrajectoryHeader& header() const = 0;
  virtual std::size_t n_frames() const = 0;
  /// Fails if the frame is damaged. `index` < n_frames().
  virtual Result<RecordedFrame> frame(std::size_t index) const = 0;
};

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
