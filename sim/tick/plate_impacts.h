// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/effects/registry.h"
#include "sim/lanes/double_lanes.h"
#include "sim/tick/surface_impacts.h"
#include "sim/tick/tick.h"

/// What most visits to rods come to, for several rods at a time: a rod flies to the tick, and one of its beads is hit
/// by a plate. Each lane goes through the operations of meet_surfaces (tick/surface_impacts.h) in their order, so
/// that the bits are the same. What is rarer is left to meet_surfaces.
namespace shaken {

/// Whether the lanes know all that the scene asks for: every effect of the registry that is on stands in the table of
/// plate_impacts.cpp. An effect that is added to the registry is refused until it is entered there.
bool lanes_know(const System& system, std::span<const Effect> effects = all_effects());

/// What is left to do for the rods in the lanes: a bit for each rod, the first one lowest.
struct LeftByLanes {
  std::uint32_t all;   ///< all of it, with a pose that is still to be worked out: meet_surfaces
  std::uint32_t hits;  ///< the hits on the beads that were found: meet_surfaces_from
  std::array<BeadsInPlates, lanes::kDoubleLanes> beads;  ///< of those
};

/// Phase 1 of a tick for up to kDoubleLanes rods of one species, but for side walls. `at_tick` gets the pose of each
/// rod and, where a bead is in a plate, its motion. The lanes give impulses too where plates act as they usually do:
/// with friction, by Newton's law with constant restitution, at the end of the tick, without noise, and strong enough
/// to throw rods. Otherwise they find the beads only.
LeftByLanes meet_plates_in_lanes(std::span<const int> rods, const std::vector<Flight>& flights,
                                 std::vector<RodAtTick>& at_tick, const PlateState& plates, Tick now,
                                 const TickRules& rules, Counters& counters);

}  // namespace shaken
