#pragma once

#include "base/core/types.h"
#include "sim/world.h"

namespace shaken {

/// Translation and rotation of all rods at the world's tick [pJ].
struct KineticEnergy {
  double translation_xy = 0;
  double translation_z = 0;
  double rotation = 0;
  double total() const { return translation_xy + translation_z + rotation; }
};
KineticEnergy kinetic_energy(const World& world);

/// What all rods have at the world's tick.
Content content(const World& world);

/// The energy and momentum balance of a run: what the rods had, got, lost and have. What remains unexplained is
/// rounding.
struct Balance {
  double energy_start = 0;                   ///< [pJ]
  double energy_given_by_surfaces = 0;       ///< by moving plates and walls [pJ]
  double energy_given_by_noise = 0;          ///< [pJ]
  double energy_lost_rod_rod = 0;            ///< in impacts of rods with each other [pJ]
  double energy_lost_surfaces = 0;           ///< in impacts with plates and walls [pJ]
  double energy_now = 0;                     ///< [pJ]
  double energy_unexplained = 0;             ///< start + given - lost - now [pJ]
  Vec3 momentum_unexplained = Vec3::Zero();  ///< start + given by plates, walls and gravity - now [mg mm/s]
  /// The unexplained energy as a fraction of all that changed hands.
  double energy_error() const;
};
Balance balance(const World& world);

}  // namespace shaken
