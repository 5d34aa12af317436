// SPDX-License-Identifier: MIT
#pragma once

#include "sim/core/rng.h"
#include "sim/stepping/tick.h"

namespace shaken {

/// Rotational noise: plates are rough, so each hit by one also turns the rod about the vertical, to either side at
/// random.
/// Model:  angular velocity about z += +-epsilon |u_n|, u_n the speed of the hit; both signs alike likely.
/// Units:  epsilon [rad/mm] (Scene::rotational_noise), u_n [mm/s].
/// The sign depends on seed, rod, bead and tick only, so it is the same for every stepper and number of threads.
inline void turn_at_random(int index, int bead, RodAtTick& rod, const RodKind& kind, double speed, Tick now,
                           const TickRules& rules, Counters& counters) {
  Rng rng(rules.seed ^ (static_cast<std::uint64_t>(now) * 0x9e3779b97f4a7c15ULL), RngStream::kNoise,
          (static_cast<std::uint64_t>(index) << 16) + static_cast<std::uint64_t>(bead));
  const Vec3 turn(0, 0, (rng.bits() >> 63 ? 1.0 : -1.0) * rules.rotational_noise * speed);
  // energy of rotation: w . I w / 2, with I w = I_perp w + (I_par - I_perp) (w . n) n
  const Vec3 mean = rod.motion.angular_velocity + 0.5 * turn;
  const Vec3& n = rod.pose.director;
  const double gained = kind.species.inertia_perp * mean.dot(turn) +
                        (kind.species.inertia_par - kind.species.inertia_perp) * mean.dot(n) * turn.dot(n);
  rod.motion.angular_velocity += turn;
  rod.changed = true;
  counters.ledger.noise.add(gained);
  ++counters.noise_kicks;
}

}  // namespace shaken
