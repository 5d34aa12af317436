// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/lanes/double_lanes.h"
#include "sim/stepping/tick.h"

/// What most visits to rods come to, for several rods at a time: a rod flies to the tick, and one of its beads is hit
/// by a plate. Each lane goes through the operations of meet_surfaces (stepping/surface_impacts.h) in their order, so
/// that the bits are the same. What is rarer is left to meet_surfaces.
namespace shaken {

/// Whether the scene's plates are such as this knows: Newton's law with friction, impacts at the tick's end.
bool hits_in_lanes(const TickRules& rules);

/// Phase 1 of a tick for up to kDoubleLanes rods of one species, but for side walls. `at_tick` gets the pose of each
/// rod and, where a bead is in a plate, its motion. Returns a bit for each rod, the first one lowest, for which that is
/// left to meet_surfaces, with a pose that is still to be worked out.
std::uint32_t meet_plates_in_lanes(std::span<const int> rods, const std::vector<Flight>& flights,
                                   std::vector<RodAtTick>& at_tick, const PlateState& plates, Tick now,
                                   const TickRules& rules, Counters& counters);

}  // namespace shaken
