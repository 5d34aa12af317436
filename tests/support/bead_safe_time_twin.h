// SPDX-License-Identifier: MIT
#pragma once

#include "sim/contact/safe_time.h"

namespace shaken::test {

/// Slow twin of bead_safe_time: every bead against every bead, in doubles, one at a time.
inline double bead_safe_time_twin(const Species& i, const FlightState& state_i, const Species& j,
                                  const FlightState& state_j, const Vec3& D, const Allowance& allowance,
                                  double horizon) {
  const double stray = 2.0 * allowance.velocity + (i.half_length + j.half_length) * allowance.precession;
  const double turn_i = std::sqrt(state_i.rate2) + allowance.precession;
  const double turn_j = std::sqrt(state_j.rate2) + allowance.precession;
  double safe = horizon;
  for (int a = 0; a < i.n_beads(); ++a) {
    for (int b = 0; b < j.n_beads(); ++b) {
      const Vec3 r = D + j.bead_offset[b] * state_j.director - i.bead_offset[a] * state_i.director;
      const Vec3 r_rate =
          state_j.velocity - state_i.velocity + j.bead_offset[b] * state_j.turning - i.bead_offset[a] * state_i.turning;
      const double gap = r.norm() - i.bead_radius[a] - j.bead_radius[b];
      const double rate = r_rate.dot(r) / r.norm() - stray;
      const double curvature =
          0.5 * (std::abs(i.bead_offset[a]) * turn_i * turn_i + std::abs(j.bead_offset[b]) * turn_j * turn_j);
      if (gap > 0) {
        const double root = std::sqrt(rate * rate + 4 * curvature * gap);
        if (rate > 0 && curvature > 0) {
          safe = std::min(safe, (rate + root) / (2 * curvature));
        } else if (rate <= 0) {
          safe = std::min(safe, 2 * gap / (root - rate));
        }
      } else {
        safe = std::min(safe, rate > 0 ? (curvature > 0 ? rate / (2 * curvature) : kForever) : 0.0);
      }
    }
  }
  return safe;
}

}  // namespace shaken::test
