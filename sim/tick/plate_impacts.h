#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/effects/registry.h"
#include "sim/lanes/double_lanes.h"
#include "sim/tick/tick.h"

/// What most visits to rods come to, for several rods at a time: a rod flies to the tick, and one of its beads is hit
/// by a plate. Each lane goes through the operations of meet_surfaces (tick/surface_impacts.h) in their order, so
/// that the bits are the same. What is rarer is left to meet_surfaces.
namespace shaken {

/// Whether the lanes know all that the scene asks for: every effect of the registry that is on stands in the table of
/// plate_impacts.cpp. An effect that is added to the registry is refused until it is entered there.
bool lanes_know(const System& system, std::span<const Effect> effects = all_effects());

/// Phase 1 of a tick for up to kDoubleLanes rods of one species, but for side walls and posts. `at_tick` gets the pose
/// of each rod and, where a bead is in a plate, its motion; `flight_pose`, with impacts at their instant only, the pose
/// before a plate displaced it. Returns a bit for each rod, the first one lowest: whether it is unresolved, so
/// that meet_surfaces is to do all, from its pose on.
std::uint32_t meet_plates_in_lanes(std::span<const int> rods, const std::vector<Flight>& flights,
                                   std::vector<RodAtTick>& at_tick, std::vector<Pose>& flight_pose,
                                   const PlateState& plates, Tick now, const TickRules& rules, Counters& counters);

}  // namespace shaken
