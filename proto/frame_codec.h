#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <shaken/frame_t.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/core/box.h"

namespace shaken::proto {

/// Rods of one chunk at most: 8 bytes each, so that a message stays under 60 kB and within one datagram.
inline constexpr int kRodsPerChunk = 7000;

/// Chunks of one frame at most: what is kept of an unfinished frame has a limit.
inline constexpr int kMostChunks = 1000;

/// One rod seen from above.
struct RodPose {
  double x = 0;      ///< of the centre, in [0, box side) [mm]
  double y = 0;      ///< the same [mm]
  double theta = 0;  ///< in-plane angle of its axis, in [-pi, pi] [rad]; 0 for an upright rod
  double n_z = 0;    ///< vertical part of its axis, in [-1, 1]

  /// The unit vector along the rod, to its head.
  std::array<double, 3> axis() const;
};

/// The pose of a rod with centre (x, y) along the unit vector `axis`.
RodPose make_pose(double x, double y, const std::array<double, 3>& axis);

/// A whole frame, before it is cut into chunks and after they are put together.
struct Frame {
  std::int64_t utime = 0;
  std::int64_t sequence = 0;
  std::string job_id;
  double sim_time_s = 0;
  std::int64_t tick = 0;
  Box box;  ///< sides [mm]
  double order = 0;
  double director_rad = 0;
  std::vector<RodPose> rods;
};

/// The messages of a frame, at least one. Errors of the quantities after decode_chunk: half of a side/65536 in x and
/// y, pi/65536 in theta, 1/65534 in n_z.
std::vector<frame_t> encode_frame(const Frame& frame);

/// The rods of one chunk, in order.
std::vector<RodPose> decode_chunk(const frame_t& chunk);

/// Puts the frames of one job together from chunks that arrive in any order, twice or not at all.
class FrameAssembler {
 public:
  explicit FrameAssembler(std::string job_id) : job_id_(std::move(job_id)) {}

  /// The frame that this chunk completes. Chunks of other jobs, of frames older than the newest seen, and chunks that
  /// contradict themselves or their siblings are ignored. Where several older frames have come and none that is newer,
  /// the newest was not the sender's: anybody can send one. From then on the older ones are followed.
  std::optional<Frame> add(const frame_t& chunk);

  /// Frames that were sent between the first and the newest complete one, but did not become complete here.
  std::int64_t lost() const { return lost_; }

 private:
  std::string job_id_;
  std::map<std::int32_t, frame_t> chunks_;  ///< of the newest frame, by number
  std::int64_t newest_ = -1;                ///< sequence of the newest frame seen
  std::int64_t newest_utime_ = 0;           ///< its time: a run that is started again counts from 0
  std::int64_t older_ = -1;                 ///< sequence of the last frame that was ignored as older
  int n_older_ = 0;                         ///< such frames since the newest
  std::int64_t completed_ = -1;             ///< sequence of the newest complete frame
  std::int64_t lost_ = 0;
};

}  // namespace shaken::proto
