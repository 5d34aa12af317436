#pragma once

#include <string>
#include <vector>

#include "base/core/result.h"
#include "python/native/simulated_run.h"
#include "run/measure/measurement_kinds.h"
#include "run/measure/reduction.h"
#include "sim/snapshot.h"

namespace shaken::python {

/// What was measured on frames that come from arrays.
struct Measured {
  std::string scene;  ///< as JSON, by which it was measured
  std::string summary;
  run::Observables arrays;
};

/// Measures `frames` of rods of one species, `interval` [s] apart, as `shaken measure` does those of a table: in single
/// precision. `scene` says what, and has the box and the rods' shape; ticks and times of the frames are set here. A
/// height that is no number is that of the middle plane, and a rod without a place is missed; where crossings of the
/// border are not counted, they are here. The box of a frame, if it has one, must be the scene's. `is_tracked`:
/// velocities that there are are displacements. `go_on` is asked at each frame. Fails with what is wrong with the scene
/// or with a frame.
Result<Measured> measure_arrays(const Scene& scene, std::vector<Snapshot> frames, double interval, run::Lacking lacking,
                                bool is_tracked, const GoOn& go_on);

}  // namespace shaken::python
