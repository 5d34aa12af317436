#pragma once

#include "sim/lanes/lanes.h"
#include "sim/motion/plates.h"
#include "sim/motion/rest_speed.h"
#include "sim/rod/species.h"

namespace shaken {

using lanes::kLanes;

/// kLanes rods in flight, at the tick from which time is counted.
struct PlateLanes {
  alignas(64) float z[kLanes];         ///< height of the centre [mm]
  alignas(64) float velocity[kLanes];  ///< of the centre, upwards [mm/s]
  alignas(64) float n_z[kLanes];       ///< director's z
  alignas(64) float n_z_rate[kLanes];  ///< [1/s]
  alignas(64) float rate2[kLanes];     ///< |precession|^2 [1/s^2]
};

/// Which plates there are, and how rods rest on the base.
struct PlatesThere {
  bool base = true;
  bool lid = true;
  RestSpeed rest = {};
};

/// Number of ticks after `now` for which no bead of each rod begins to touch a plate or, if it is in one, begins to
/// approach it, or on the base is about to leave it slower than rods at rest must; at most `horizon`, for the first `n`
/// rods. Rigorous: the plates are followed exactly, the outer beads by n_z(t) in n_z + n_z' t -+ W^2 t^2 / 2, and
/// between the ticks looked at the relative acceleration is bounded by g + a Omega^2 + h W^2. Numerics: floats, with
/// margins for their rounding.
void plate_safe_ticks(const Species& species, const PlateMotion& plates, const PlateLanes& rods, int n, double gravity,
                      double dt, Tick now, Tick horizon, Tick* safe, PlatesThere there = {});

}  // namespace shaken
