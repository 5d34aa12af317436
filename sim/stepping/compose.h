// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "sim/stepping/tick.h"

namespace shaken {

/// The inner loops of a tick, made of those effects that a scene calls for and of nothing else. All steppers run these.
///
/// Laws are compile-time policies: which law rules the impacts of rods with each other and with surfaces, whether they
/// have friction, whether they take place at their own instant, whether plates are rough. compose.cpp is the one place
/// where they are instantiated, and this is the one place where a scene is turned into a choice of them; what remains
/// is one call through a pointer for each rod or tick. An effect that is off is bitwise what its neutral parameter
/// gives.
struct Kernels {
  /// Phase 1 for one rod: impulses from base, lid and side walls. Trouble if a bead is too deep in one of them.
  using MeetSurfaces = std::optional<NumericalTrouble> (*)(int index, RodAtTick& rod, const Flight& flight,
                                                           const PlateState& plates, Tick now, const TickRules& rules,
                                                           Counters& counters);
  /// Phase 3. `contacts` are sorted; `rods` holds those concerned as of tick `now`.
  using Respond = std::optional<NumericalTrouble> (*)(const std::vector<PairContact>& contacts,
                                                      std::vector<RodAtTick>& rods, World& world, Tick now,
                                                      const TickRules& rules);
  MeetSurfaces meet_surfaces;
  Respond respond;
};

Kernels compose(const Scene& scene);

/// Every effect compiled in, whether the scene needs it or not: for tests and for measuring what `compose` saves.
/// Bitwise the same as compose(scene).
Kernels compose_everything(const Scene& scene);

}  // namespace shaken
