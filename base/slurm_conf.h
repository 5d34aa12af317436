// SPDX-License-Identifier: MIT
// Where Slurm's programs find their cluster. Each process has it from its environment, and keeps it.
#pragma once

#include <optional>
#include <string>

namespace shaken {

/// "SLURM_CONF=/etc/slurm/slurm.conf" of this process, with ", where there is no file" if so; or that it is not set.
std::string slurm_conf_text();

/// The file that SLURM_CONF names, if it is not there.
std::optional<std::string> missing_slurm_conf();

}  // namespace shaken
