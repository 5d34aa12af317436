// SPDX-License-Identifier: MIT
#include "bench/accuracy/errors.h"

#include <cmath>

#include "sim/balance.h"

namespace shaken::bench {

Errors errors_between(const World& state, const World& truth) {
  const Snapshot a = snapshot(state);
  const Snapshot b = snapshot(truth);
  double position = 0;
  double angle = 0;
  for (std::size_t i = 0; i < b.n_rods(); ++i) {
    Vec3 apart = a.position[i] - b.position[i];
    for (int axis = 0; axis < 2; ++axis) apart[axis] += (a.image[i][axis] - b.image[i][axis]) * b.box_side;
    position += apart.squaredNorm();
    // exact for small angles too, where the cosine loses all digits
    const double turn = 2 * std::atan2((a.director[i] - b.director[i]).norm(), (a.director[i] + b.director[i]).norm());
    angle += turn * turn;
  }
  const auto n = static_cast<double>(b.n_rods());
  const double energy = kinetic_energy(truth).total();
  return {std::sqrt(position / n), std::sqrt(angle / n), std::abs(kinetic_energy(state).total() - energy) / energy};
}

}  // namespace shaken::bench
