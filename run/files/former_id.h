// SPDX-License-Identifier: MIT
// Before runs could be extended, the id of a run depended on its length too. Its files are taken up under the new id.
#pragma once

#include <string>

#include "base/core/result.h"
#include "run/files/directory.h"
#include "scene/run_plan.h"

namespace shaken::run {

/// Gives the checkpoints and the summary in `directory`, which are of `plan`, the run's id where they carry the
/// former one; others are left as they are. What cannot be read is left too: it is told when it is needed.
Result<void> renew_id(const RunDirectory& directory, const scene::RunPlan& plan);

}  // namespace shaken::run
