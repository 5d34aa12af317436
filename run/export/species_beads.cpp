// SPDX-License-Identifier: MIT
#include "run/export/species_beads.h"

namespace shaken::run {

std::vector<BeadRow> beads_of_species(const TrajectoryHeader& header) {
  std::vector<BeadRow> species{{header.bead_offset, header.bead_radius}};
  species.insert(species.end(), header.added_beads.begin(), header.added_beads.end());
  return species;
}

std::size_t species_of_rod(const TrajectoryHeader& header, std::size_t rod) {
  return header.species_of_rod.empty() ? 0 : header.species_of_rod[rod];
}

std::string letter_of(std::size_t species) { return {static_cast<char>('A' + species)}; }

}  // namespace shaken::run
