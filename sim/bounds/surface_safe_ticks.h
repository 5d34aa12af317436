#pragma once

#include <span>
#include <vector>

#include "sim/bounds/plate_safe_time.h"
#include "sim/tick/tick.h"

namespace shaken {

/// Ticks after `now` for which plates, walls and posts certainly do nothing to the first kLanes `rods`, all of one
/// species, at most `horizon`. `at_tick` holds the rods as of tick `now`; `lanes` is scratch.
void off_surface_ticks(std::span<const int> rods, const World& world, const std::vector<RodAtTick>& at_tick, Tick now,
                       Tick horizon, const TickRules& rules, PlateLanes& lanes, Tick* ticks);

}  // namespace shaken
