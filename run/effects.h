// SPDX-License-Identifier: MIT
#pragma once

#include "run/session.h"
#include "run/summary.h"

namespace shaken::run {

/// Every effect that a plan may call for, on or off, with the work that it did in this run. `n_live_frames`: none if no
/// live state was sent.
std::map<std::string, EffectReport> report_effects(const scene::RunPlan& plan, const Session& session,
                                                   std::optional<std::int64_t> n_live_frames);

}  // namespace shaken::run
