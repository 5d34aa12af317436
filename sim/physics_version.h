#pragma once

#include "sim/system.h"

namespace shaken {

/// Version of the physics of a scene: raised for those scenes whose trajectory a change alters by as much as a bit. A
/// checkpoint is continued by programs of the same version only, and it is part of every run's name; summary.json tells
/// it, CHANGELOG.md what each one changed.
///   4  rods that rest on a base with friction (weak plates)
///   3  all others
inline int physics_version(const System& system) {
  bool rubs = false;
  for (std::size_t number = 0; number < kMostSpecies; ++number)
    rubs |= system.has_species(number) && system.rod_base.of(number).has_friction();
  return system.lets_rods_rest() && rubs ? 4 : 3;
}

}  // namespace shaken
