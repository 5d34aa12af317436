#pragma once

#include <cstddef>
#include <vector>

#include "base/core/result.h"
#include "run/files/directory.h"
#include "run/files/trajectory.h"

namespace shaken::run {

/// S(t) of a run.
struct OrderCurve {
  std::vector<double> times;   ///< (n), increasing [s]
  std::vector<double> orders;  ///< (n), in [0, 1]
};

/// S of recorded frames, at most `most` of them, from the first to the last and evenly between. Empty of spheres, which
/// have no S, and without frames. Fails if one of them is damaged.
Result<OrderCurve> order_of_frames(const TrajectoryReader& frames, std::size_t most);

/// S(t) of a run as far as its directory has it, also while the run is at work: of at most `most` of its frames, and of
/// at most 64 MB of them; where there are none, of its observables.h5. Fails if there is neither, or if it is damaged.
Result<OrderCurve> recorded_order(const RunDirectory& directory, std::size_t most);

}  // namespace shaken::run
