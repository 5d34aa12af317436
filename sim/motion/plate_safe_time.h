// SPDX-License-Identifier: MIT
#pragma once

#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/rod/species.h"

namespace shaken {

/// Number of ticks after `now` for which no bead of a flying rod begins to touch a plate or, if it is in one, begins to
/// approach it; at most `horizon`. Rigorous: the plates are followed exactly, the rod's ends by
/// n_z(t) in n_z + n_z' t -+ W^2 t^2 / 2, and between the ticks looked at the relative acceleration is bounded by
/// g + a Omega^2 + h W^2.
/// Arguments: height z [mm] and velocity v_z [mm/s] of the centre, n_z, n_z' [1/s], W^2 [1/s^2], all at `now`.
Tick plate_safe_ticks(const Species& species, const PlateMotion& plates, double z, double v_z, double n_z,
                      double n_z_rate, double rate2, double gravity, double dt, Tick now, Tick horizon);

}  // namespace shaken
