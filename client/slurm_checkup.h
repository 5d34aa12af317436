#pragma once

#include <filesystem>
#include <vector>

#include "client/checkup.h"

namespace shaken::client {

/// Looks at what runs in Slurm need besides: its programs here, a controller that answers, arrays that are large
/// enough, and nodes that see the daemon's root and Shaken's programs. The last starts a moment's job, if a node is
/// free.
std::vector<CheckResult> slurm_checkup(const std::filesystem::path& root);

}  // namespace shaken::client
