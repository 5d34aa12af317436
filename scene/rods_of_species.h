#pragma once

#include <cstddef>

#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// The mean rods of species `number` (0: rods, 1: rods_2, ...), which `plan` must have, and nothing but them: on the
/// plates of the plan, shaken as there, with the contacts and the noise of that species, the same gap, gravity and time
/// step; in a square periodic box at random places, without walls, posts and measurements. Number and box are the
/// plan's own, for the caller to change.
RunPlan rods_of_species(const RunPlan& plan, std::size_t number);

}  // namespace shaken::scene
