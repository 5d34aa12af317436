// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/core/types.h"

namespace shaken::analysis {

/// Powers on the wave vectors q = 2 pi (m, n) / L of a periodic box, one of each pair +-q: m in [0, waves], n in
/// [-waves, waves]. Of m = 0 both signs of n are there, with the same power.
struct WavePowers {
  int waves = 0;
  std::vector<double> values;  ///< (waves + 1, 2 waves + 1), n fastest

  std::size_t index(int m, int n) const {
    return static_cast<std::size_t>(m) * static_cast<std::size_t>(2 * waves + 1) + static_cast<std::size_t>(n + waves);
  }
  double at(int m, int n) const { return values[index(m, n)]; }
};

/// |sum_i w_i exp(-i q . r_i)|^2 over places (n) [mm] with weights (n) in a box of side `box_side` [mm]. Costs about
/// 4 n (waves + 1)^2 multiplications. Sums are taken in one order on every machine.
WavePowers wave_powers(std::span<const Vec2> places, std::span<const double> weights, double box_side, int waves);

}  // namespace shaken::analysis
