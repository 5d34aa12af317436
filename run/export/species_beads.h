// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "run/files/recorded_frames.h"

namespace shaken::run {

/// The beads of each species, the first species first.
std::vector<BeadRow> beads_of_species(const TrajectoryHeader& header);
/// The species of a rod, from 0.
std::size_t species_of_rod(const TrajectoryHeader& header, std::size_t rod);
/// "A" for the first species.
std::string letter_of(std::size_t species);

}  // namespace shaken::run
