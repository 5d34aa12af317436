#pragma once

#include <functional>

#include "base/core/result.h"
#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

/// Asked now and then during long work; once it says false, the work is given up.
using GoOn = std::function<bool()>;

/// The world at tick 0 of a start that is_compressed(), dense and disordered or along a pattern: random places and
/// directions in a box in which the rods are dilute; then this box shrinks in small steps, and all centres with it,
/// while the rods fly about and hit each other. Without a pattern it ends as a hard-particle gas that has been
/// compressed too fast to order.
///
/// Model:    between the steps the simulator itself moves the rods, between two plates at rest that are at most
///           one and a half thicknesses apart, without gravity and friction, with restitution 1. A step may push rods
///           into each other by a small part of a bead's radius; their next impulses drive them apart. Beads are a
///           hundredth thicker meanwhile, so that true rods are apart at the end, which is checked.
/// Patterns: where rods start along domains or a pair of defects (sim/start/director_patterns.h), they are inserted
///           along the director of their place, with the head at either end, and turned towards it between the steps by
///           a field (sim/start/director_patterns.h). Turns that hits give them last until the next step.
/// Posts:    they shrink with the box, with the ways between them, so that posts that touch do so all along.
/// Source:   as the quick compression of hard particles of HOOMD-blue (Anderson et al. 2020), with impulses in place
///           of Monte Carlo moves.
/// Numerics: depends on the system alone: bitwise the same at every compiler and number of threads.
/// Errors:   side walls; rods that jam before the box is as small as wanted (the message says how far it came); or
///           "stopped", once `go_on` says so. It is asked some ten times a second.
/// Velocities at tick 0 are those of any other start.
Result<World> make_compressed_world(const System& system, const GoOn& go_on = {});

/// The world at tick 0 of a run that goes on from another in a box of another side, or with another gap: the rods of
/// `left` at its tick, as which they begin; then side and gap become those of `system` in small steps, while the rods
/// fly about between plates at rest as above. So a packing is changed without a change of the rods: all centres keep
/// their places in units of the box, and directors change only where rods hit each other.
///
/// Errors: rods, their number, plates or the shape of the box are not those of `left`; or it has walls or posts; or
/// rods jam.
/// Velocities at tick 0 are those of any other start, since those of `left` have been lost in the gas.
Result<World> make_resized_world(const System& system, const World& left, const GoOn& go_on = {});

}  // namespace shaken
