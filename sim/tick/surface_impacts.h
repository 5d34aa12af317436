#pragma once

#include <optional>

#include "sim/tick/tick.h"

namespace shaken {

/// Phase 1 of a tick (tick/tick.h) for one rod: impulses from base, lid, side walls and posts. Of each of them the
/// deepest bead comes first, and the next one is looked for as the rod moves by then. `rod` is as of tick `now`.
/// Returns trouble if a bead is too deep in one of them.
std::optional<NumericalTrouble> meet_surfaces(int index, RodAtTick& rod, const Flight& flight, const PlateState& plates,
                                              Tick now, const TickRules& rules, Counters& counters);
/// Its last part: side walls and posts.
std::optional<NumericalTrouble> meet_uprights(int index, RodAtTick& rod, const Flight& flight, const PlateState& plates,
                                              Tick now, const TickRules& rules, Counters& counters);

}  // namespace shaken
