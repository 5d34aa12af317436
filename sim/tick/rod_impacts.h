#pragma once

#include <optional>
#include <vector>

#include "sim/tick/tick.h"

namespace shaken {

/// Phase 3 of a tick (tick/tick.h): impulses between rods. `contacts` are sorted (sort_contacts); `rods` holds
/// those concerned as of tick `now`. Returns trouble if two beads overlap too deeply.
std::optional<NumericalTrouble> collide_rods(const std::vector<PairContact>& contacts, std::vector<RodAtTick>& rods,
                                             World& world, Tick now, const TickRules& rules);

}  // namespace shaken
