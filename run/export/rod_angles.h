#pragma once

#include <vector>

#include "run/files/recorded_frame.h"
#include "run/files/recorded_frames.h"

namespace shaken::run {

/// (n_rods) in-plane angles of the rods to the director of the first species in the same frame, in [-pi/2, pi/2) [rad]:
/// what pictures colour rods by. NaN for spheres, for upright rods, and for all where the first species are spheres.
std::vector<float> rod_angles(const TrajectoryHeader& header, const RecordedFrame& frame);

}  // namespace shaken::run
