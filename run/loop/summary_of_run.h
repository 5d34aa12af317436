#pragma once

#include <cstdint>
#include <optional>

#include "run/loop/open_run.h"
#include "run/loop/summary.h"

namespace shaken::run {

/// What a run of `plan` comes down to where it stands, but for the time that it took and for its files.
/// `n_live_frames`: none if no live state was sent.
Summary summary_of(const scene::RunPlan& plan, const OpenRun& run, const Reduction& reduction,
                   std::optional<std::int64_t> n_live_frames);

}  // namespace shaken::run
