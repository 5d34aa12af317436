#pragma once

#include <vector>

#include "base/core/result.h"
#include "sim/start/director_patterns.h"
#include "sim/start/placement.h"

namespace shaken {

/// Flights at tick 0 of flat rods at random places and in random directions, one after the other where there is room
/// (random sequential insertion); along `directors` if they are given, with the head at either end. Errors: the rods
/// do not fit; the message names how many had been placed when there was no room for another.
Result<std::vector<Flight>> random_rods(const Placement& rods, const DirectorAt& directors);

}  // namespace shaken
