#pragma once

#include <optional>
#include <string>

#include "run/files/directory.h"
#include "scene/keys/run_plan.h"

namespace shaken::run {

/// Whether a run came to its end in `directory`, as its summary says: run `run_id`, or any if that is empty.
bool is_done(const RunDirectory& directory, const std::string& run_id = "");
/// The tick of that end; none if it has not come there.
std::optional<Tick> done_tick(const RunDirectory& directory, const std::string& run_id);
/// The simulated time [s] at which run `run_id` came to an end before it was to go on for longer, or its end now; none
/// if it has not come to one. A summary that a stop has written since then knows it.
std::optional<double> former_end(const RunDirectory& directory, const std::string& run_id);
/// Whether the run of this plan came to its end there, and went on for as long as the plan asks (scene/length.h),
/// and its results are still there.
bool is_done(const RunDirectory& directory, const scene::RunPlan& plan);
/// Whether there is no run, but what was measured on recorded frames (run/recorded/).
bool is_of_frames(const RunDirectory& directory);

}  // namespace shaken::run
