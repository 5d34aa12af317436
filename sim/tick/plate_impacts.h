// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/effects/registry.h"
#include "sim/lanes/double_lanes.h"
#include "sim/motion/flight_lanes.h"
#include "sim/tick/tick.h"

/// What most visits to rods come to, for several rods at a time: a rod flies to the tick, and one of its beads is hit
/// by a plate. Each lane goes through the operations of meet_surfaces (tick/surface_impacts.h) in their order, so
/// that the bits are the same. What is rarer is left to meet_surfaces.
namespace shaken {

/// Whether the lanes know all that the scene asks for: every effect of the registry that is on stands in the table of
/// plate_impacts.cpp, and what the lanes always do (friction, by Newton's law) is on. An effect that is added to the
/// registry is refused until it is entered there.
bool lanes_know(const System& system, const TickRules& rules, std::span<const Effect> effects = all_effects());

/// What the plates do to several rods at a tick.
struct PlateHits {
  /// Of one plate.
  struct OfPlate {
    lanes::TripleLanes impulse;
    alignas(64) double lost[lanes::kDoubleLanes];     ///< energy
    alignas(64) double overlap[lanes::kDoubleLanes];  ///< of the bead in the plate; 0: none
    alignas(64) double is_hit[lanes::kDoubleLanes];   ///< > 0: yes, where there is an overlap
  };
  RodLanes rods;                                     ///< after the hits
  OfPlate of_plate[2];                               ///< base, lid
  alignas(64) double is_other[lanes::kDoubleLanes];  ///< >= 0: what happens is not known here

  bool is_known(int lane) const { return is_other[lane] < 0; }
  bool meets(int lane, int plate) const { return of_plate[plate].overlap[lane] > 0; }
  bool is_hit(int lane, int plate) const { return meets(lane, plate) && of_plate[plate].is_hit[lane] > 0; }
  bool is_hit(int lane) const { return is_hit(lane, 0) || is_hit(lane, 1); }

  /// Counts the lane's hits.
  void count(int lane, const PlateState& plates, Counters& counters) const;
  /// The lane's rod after them; its motion only where a bead is in a plate.
  void get(int lane, RodAtTick& rod) const;
};

/// Phase 1 of a tick for the first `n` lanes, but for side walls. `since`: how long each rod has flown [s].
void hit_plates(const SpeciesMechanics& species, const FlightLanes& flights, const double* since, int n,
                const PlateState& plates, const TickRules& rules, PlateHits& hits);

/// The same for up to kDoubleLanes rods of one species. `at_tick` gets the pose of each
/// rod and, where a bead is in a plate, its motion. Returns a bit for each rod, the first one lowest, for which that is
/// left to meet_surfaces, with a pose that is still to be worked out.
std::uint32_t meet_plates_in_lanes(std::span<const int> rods, const std::vector<Flight>& flights,
                                   std::vector<RodAtTick>& at_tick, const PlateState& plates, Tick now,
                                   const TickRules& rules, Counters& counters);

}  // namespace shaken
