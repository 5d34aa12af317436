// Where Slurm's programs find their cluster. Each process has it from its environment, and keeps it.
#pragma once

#include <optional>
#include <string>

namespace shaken {

/// "SLURM_CONF=/etc/slurm/slurm.conf" of this process, with ", where there is no file" if so; or that it is not set.
std::string slurm_conf_text();

/// The file that SLURM_CONF names, if it is not there.
std::optional<std::string> missing_slurm_conf();

/// Takes from this process's environment what would change the questions that are asked of Slurm, or its answers:
/// filters and formats of its programs (SQUEUE_*, SCANCEL_*, SINFO_*, SLURM_TIME_FORMAT), another cluster, and
/// variables of sbatch that keep it from returning at once, from submitting, or from running the tasks as they are
/// written. What says where and for how long tasks run (SBATCH_PARTITION, ...) stays. Before there are threads.
void forget_slurm_filters();

}  // namespace shaken
