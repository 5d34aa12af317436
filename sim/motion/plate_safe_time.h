// SPDX-License-Identifier: MIT
#pragma once

#include "sim/lanes/lanes.h"
#include "sim/motion/plates.h"
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

/// Speed at which a bead must leave the base where plates are too weak to throw rods: those at rest would sink [mm/s].
/// What falls for a tick and is then stopped, or thrown back by a fraction of that, has sunk a little. Leaving at half
/// the speed of a tick's fall, it is back where it was after a tick; what several contacts of a rod still sink, or what
/// was deep before, `rise_rate` brings out again.
struct RestSpeed {
  double half_fall = 0;  ///< g dt / 2, or 0 where plates throw rods: there it would never matter [mm/s]
  double rise_rate = 0;  ///< more of it per overlap [1/s]
  double at(double overlap) const { return half_fall + rise_rate * overlap; }
  bool matters() const { return half_fall > 0; }
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
