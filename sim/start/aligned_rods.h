#pragma once

#include <vector>

#include "base/core/result.h"
#include "sim/start/placement.h"

namespace shaken {

/// Flights at tick 0 of rods in rows, along x or at System::start_angle to it. Sites left over are vacancies at random
/// places; polar rods point either way. Errors: the rods do not fit; the message names the most that can be placed.
Result<std::vector<Flight>> aligned_rods(const Placement& rods);

}  // namespace shaken
