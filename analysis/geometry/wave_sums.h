#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/errors/saved.h"
#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// The wave vectors q = 2 pi (m / L_x, n / L_y) of a periodic box that are no longer than 2 pi `waves` / L along either
/// side, L being the longer one; one of each pair +-q: m in [0, most_m], n in [-most_n, most_n]. Of m = 0 both signs of
/// n are there.
struct WaveVectors {
  /// At least one wave.
  WaveVectors(const Box& box, int waves);

  Box box;
  int waves;
  int most_m, most_n;

  std::size_t size() const { return static_cast<std::size_t>(most_m + 1) * static_cast<std::size_t>(2 * most_n + 1); }
  /// The place of (m, n) among them, n fastest.
  std::size_t index(int m, int n) const {
    return static_cast<std::size_t>(m) * static_cast<std::size_t>(2 * most_n + 1) +
           static_cast<std::size_t>(n + most_n);
  }
  /// q in units of 2 pi / L: (m, n) in a square box.
  Vec2 at(int m, int n) const { return {m * (box.longer() / box.x()), n * (box.longer() / box.y())}; }
  /// 2 pi k / L [rad/mm].
  double wave_number(double k) const { return 2 * kPi * k / box.longer(); }
  /// Calls visit(m, n, at(m, n)) for all but 0, one of each pair.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int m = 0; m <= most_m; ++m) {
      for (int n = m == 0 ? 1 : -most_n; n <= most_n; ++n) visit(m, n, at(m, n));
    }
  }

  friend bool operator==(const WaveVectors&, const WaveVectors&) = default;
  static auto fields(auto& self) { return listed(self.box); }  ///< as a setting (summed.h)
};

/// |sum_i w_i exp(-i q . r_i)|^2 over places (n) [mm] with weights (n), of each wave vector. Costs about
/// 4 n (most_m + 1) (most_n + 1) multiplications. Sums are taken in one order on every machine.
std::vector<double> wave_powers(std::span<const Vec2> places, std::span<const double> weights,
                                const WaveVectors& vectors);

}  // namespace shaken::analysis
