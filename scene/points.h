// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace shaken::scene {

/// How points are spread over the unit cube.
enum class Spread {
  kRandom,  ///< independently of each other
  kLatin,   ///< Latin hypercube (McKay, Beckman & Conover 1979): in each dimension, one point in each nth of [0, 1)
  kSobol    ///< Sobol's sequence, scrambled by the seed: any part of the cube gets its share of points
};

/// n points in the unit cube, the same on every machine. A point of kRandom or kSobol does not depend on n.
struct CubePoints {
  Spread spread = Spread::kRandom;
  int n = 0;
  std::uint64_t seed = 1;

  /// The coordinates (n), in [0, 1), of all points in dimension number `dimension` (from 0), which belongs to the key
  /// `path`. What is drawn depends on seed and path, so that further keys change nothing; for kSobol the dimension
  /// matters too, and must be below kMaxSobolDimensions.
  std::vector<double> coordinates(std::string_view path, int dimension) const;
};

inline constexpr int kMaxSobolDimensions = 32;

/// Sobol's sequence in one dimension (from 0), in binary fractions of 32 digits and in the order of Gray's code.
/// Source: I. M. Sobol', USSR Comput. Math. Math. Phys. 7 (1967) 86; direction numbers of S. Joe & F. Y. Kuo, SIAM J.
/// Sci. Comput. 30 (2008) 2635, the first 32 dimensions of their list "new-joe-kuo-6".
class SobolSequence {
 public:
  explicit SobolSequence(int dimension);

  /// Point i (from 0, below 2^32), in units of 2^-32.
  std::uint32_t point(std::uint32_t i) const;

 private:
  std::array<std::uint32_t, 32> directions_{};
};

/// from (to / from)^share, with the same bits on every machine; both ends positive, `share` in [0, 1].
double between_on_log_scale(double from, double to, double share);

}  // namespace shaken::scene
