#pragma once

#include <shaken/defects_t.hpp>
#include <shaken/observables_t.hpp>

#include "proto/frame_codec.h"
#include "run/files/progress.h"
#include "run/measure/measurements.h"
#include "sim/world.h"

namespace shaken::run {

/// State into wire messages. Head fields (utime, sequence, job_id) are left to the sender. Order and director are those
/// of the rods of the first species, as in the measurements.
proto::Frame make_frame(const World& world, const Snapshot& snapshot);
observables_t make_observables(const World& world, const Snapshot& snapshot, const Progress& progress);
defects_t make_defects(const DefectSample& sample);

}  // namespace shaken::run
