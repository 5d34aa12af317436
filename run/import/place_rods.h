#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/keys/problem.h"
#include "run/import/imported_rods.h"
#include "sim/world.h"

namespace shaken::run {

/// What the species of a system are called: "rods", and "rods_2" and "rods_3" where it has them.
std::vector<std::string> species_names(const System& system);

// Deepest overlap that is accepted, in radii of the thinnest bead.
inline constexpr double kAcceptedInTables = 0.05;  ///< about as deep as hits of a simulation get
inline constexpr double kAcceptedOfRuns = 0.5;     ///< the deepest that a run may have (sim/tick/tick.h)

/// A system with the rods of a file.
struct PlacedRods {
  World world;         ///< at tick 0
  double deepest = 0;  ///< overlap that has been accepted [mm]
  int n_resting = 0;   ///< rods whose height was not given
  int n_still = 0;     ///< rods that lie flat and do not move: plates throw them straight up
};

/// The world of `system` at tick 0 with `rods`, those of each species in their order. `are_lines`: they come from lines
/// of `file`, not from a trajectory. None if something is wrong, which is added to `problems`: rods too many or too
/// few, outside of the box, in other units, in or above the plates, walls and posts, or in each other by more than is
/// accepted; the deepest 20 overlaps are listed, or that too many rods are in one place.
std::optional<PlacedRods> place_rods(const System& system, const std::vector<ImportedRod>& rods,
                                     const std::string& file, bool are_lines, std::vector<keys::Problem>& problems);

/// Gives rods that do not move the random velocities of any other start, by the seed of the system.
void draw_velocities(World& world);

}  // namespace shaken::run
