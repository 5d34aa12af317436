#pragma once

#include "base/failure.h"
#include "server/slurm/batch.h"

namespace shaken::server::slurm {

/// Does the task that SLURM_ARRAY_TASK_ID numbers, on a node of the cluster: starts its workers one after the other,
/// hands on what Slurm and the daemon ask of them, and writes down how they end. Blocks signals of this thread. Throws
/// Failure if the batch has no such task or has been withdrawn, or if the report cannot be written.
ExitCode do_task(const BatchFolder& folder);

}  // namespace shaken::server::slurm
