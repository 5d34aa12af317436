#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// One species as it is measured.
struct MeasuredRods {
  std::size_t species = 0;  ///< its number in a Cell, from 0
  std::string prefix{};     ///< in front of the names of what is found: "" of the first, "rods_2", "rods_3"
  /// The plan as these rods' observables see it: they are all its rods. Lengths that a scene leaves to be derived
  /// (measure.defects.grid and others) are those of the first species all the same.
  RunPlan plan{};
};

/// The species that the plan measures (measure.of), the first one first.
std::vector<MeasuredRods> measured_species(const RunPlan& plan);

/// The mean rods of species `number` (0: rods, 1: rods_2, ...), which `plan` must have, and nothing but them: on the
/// plates of the plan, shaken as there, with the contacts and the noise of that species, the same gap, gravity and time
/// step; in a square periodic box at random places, without walls, posts and measurements. Number and box are the
/// plan's own, for the caller to change.
RunPlan rods_of_species(const RunPlan& plan, std::size_t number);

}  // namespace shaken::scene
