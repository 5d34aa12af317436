#pragma once

#include <cstdint>
#include <vector>

#include "base/core/box.h"
#include "base/core/result.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// A frame as files keep it: in single precision, arrays rod by rod.
struct RecordedFrame {
  Tick tick = 0;
  double time = 0;                  ///< [s]
  std::vector<float> position;      ///< (n_rods, 3), wrapped into the box [mm]
  std::vector<float> velocity;      ///< (n_rods, 3) [mm/s]
  std::vector<float> orientation;   ///< (n_rods, 4): unit quaternion (w, x, y, z) that turns z into the director
  std::vector<std::int32_t> image;  ///< (n_rods, 3): how often the box was left; the third is always 0
};

/// Where rods are missed (Snapshot::track), one row for each of all, NaN where it is not there.
RecordedFrame record(const Snapshot& snapshot);
/// The frame without angular velocities, which files lack. Fails, naming the rod, if a number is none that a rod in
/// a box of sides `box` [mm] can have: orientations are of unit length, positions in the box, everything finite. Rods
/// that `were_tracked` may be missed, all of whose numbers are none then.
Result<Snapshot> decode(const RecordedFrame& frame, const Box& box, bool were_tracked = false);

}  // namespace shaken::run
