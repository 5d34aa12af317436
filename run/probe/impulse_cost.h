// SPDX-License-Identifier: MIT
#pragma once

#include "sim/world.h"

namespace shaken::run {

/// How much longer one impulse takes by the parameters of its contact than by neutral ones [s].
struct ImpulseCost {
  double friction = 0;     ///< against the same impulse without friction
  double restitution = 0;  ///< against the same impulse without bounce
};

/// What a rod hits: that decides from where.
enum class Against { kPlate, kRod };

/// Times the impulse law of one kind of contact on the rods of `world`: a contact at one end of each rod, approached
/// at its own velocity. What is left of the difference below the noise of the clock is 0.
ImpulseCost time_impulses(const World& world, const ContactParameters& contact, Against what);

}  // namespace shaken::run
