#pragma once

#include <string>

#include "run/files/recorded_frame.h"
#include "run/files/recorded_frames.h"

namespace shaken::run {

/// Height that the plates sweep, so that no rod is ever above it. The gap alone if the header's scene is not known
/// here. [mm]
double swept_height(const TrajectoryHeader& header);

/// The comment lines of frames in extended XYZ, whose columns are `properties`.
class XyzComment {
 public:
  XyzComment(const TrajectoryHeader& header, const std::string& properties);
  /// The box, the columns, which borders are periodic, time, tick, the run and its walls.
  std::string of(const RecordedFrame& frame) const;

 private:
  std::string before_time_;
  std::string after_time_;
};

}  // namespace shaken::run
