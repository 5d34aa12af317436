#pragma once

#include <filesystem>
#include <vector>

#include "base/core/result.h"
#include "server/queue/queue.h"

namespace shaken::server {

/// The jobs of a sweep with `n` replicas of each of its points, or as many as there are if these are more: those that
/// are there, and new ones with further seeds, as if its file had been submitted so. `runs`: folder of the run
/// directories, where it is looked whether results are there. Fails where the seed is swept, or where a scene is of
/// other physics.
Result<std::vector<NewJob>> with_replicas(const Queue& queue, std::int64_t sweep, int n,
                                          const std::filesystem::path& runs);

}  // namespace shaken::server
