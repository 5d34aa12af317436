#pragma once

#include "base/core/rng.h"
#include "sim/tick/tick.h"

namespace shaken {

/// To which side noise turns a rod, +1 or -1. It depends on seed, rod, tick and `hit`, which of the rod's hits in the
/// tick this is, only, so it is the same for every stepper and number of threads.
inline double sign_of_noise(int index, int hit, Tick now, const TickRules& rules) {
  Rng rng(rules.system.seed, RngStream::kNoise, now,
          (static_cast<std::uint64_t>(index) << 16) + static_cast<std::uint64_t>(hit));
  return rng.bits() >> 63 ? 1.0 : -1.0;
}

/// Rotational noise: plates are rough, so each hit by one also turns the rod about the vertical, to either side at
/// random.
/// Model:  angular velocity += +-epsilon |u_n| (z - n_z n), u_n the speed of the hit, both signs equally likely. The
///         part of z along the rod is left out, so that rods do not begin to spin about themselves.
/// Units:  epsilon [rad/mm], of the rod's species (System::noise_of), u_n [mm/s].
inline void turn_at_random(int index, int hit, RodAtTick& rod, const SpeciesMechanics& species, double speed, Tick now,
                           const TickRules& rules, Counters& counters) {
  const Vec3& n = rod.pose.director;
  const double kick = sign_of_noise(index, hit, now, rules) * species.rotational_noise * speed;
  const Vec3 turn = kick * (Vec3::UnitZ() - n.z() * n);
  const double gained = species.inertia_perp * (rod.motion.angular_velocity + 0.5 * turn).dot(turn);
  rod.motion.angular_velocity += turn;
  rod.changed = true;
  counters.ledger.noise.add(gained);
  ++counters.noise_kicks;
}

}  // namespace shaken
