// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

// Vectors go from function to function in registers here, or the function is not inlined and all is lost: the warning
// that it would then be done differently on other machines is beside the point.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Sixteen floats that are computed with as one, by the compiler's own vectors: whatever the machine has, from one
/// register of AVX-512 to four of SSE, and the same bits on all of them. For bounds and filters, whose results decide
/// where to look and never what is found. The functions are inlined by force so that they become part of whichever
/// clone of their caller (core/vector_clones.h) the machine runs.
namespace shaken::lanes {

inline constexpr int kLanes = 16;

using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

#define SHAKEN_LANES [[gnu::always_inline]] inline

/// x in every lane.
SHAKEN_LANES Floats all(float x) { return Floats{} + x; }
SHAKEN_LANES Floats load(const float* from) {
  Floats x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}
SHAKEN_LANES void store(float* to, const Floats& x) { __builtin_memcpy(to, &x, sizeof x); }

SHAKEN_LANES Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }
SHAKEN_LANES Floats smaller(const Floats& a, const Floats& b) { return a < b ? a : b; }
SHAKEN_LANES Floats clamp(const Floats& x, const Floats& limit) { return larger(-limit, smaller(limit, x)); }
SHAKEN_LANES Floats abs(const Floats& x) { return reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) & 0x7fffffff); }
/// |size|, with the sign of `sign`.
SHAKEN_LANES Floats with_sign_of(const Floats& size, const Floats& sign) {
  return reinterpret_cast<Floats>((reinterpret_cast<Ints>(size) & 0x7fffffff) |
                                  (reinterpret_cast<Ints>(sign) & static_cast<std::int32_t>(0x80000000)));
}
/// Towards zero; |x| < 2^31.
SHAKEN_LANES Floats truncated(const Floats& x) {
  return __builtin_convertvector(__builtin_convertvector(x, Ints), Floats);
}
SHAKEN_LANES Floats sqrt(const Floats& x) {
  Floats root;
  for (int l = 0; l < kLanes; ++l) root[l] = std::sqrt(x[l]);
  return root;
}
/// The least of all lanes.
SHAKEN_LANES float least(const Floats& x) {
  const Ints eight{8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7};
  const Ints four{4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11};
  const Ints two{2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13};
  Floats y = smaller(x, __builtin_shuffle(x, eight));
  y = smaller(y, __builtin_shuffle(y, four));
  y = smaller(y, __builtin_shuffle(y, two));
  return y[0] < y[1] ? y[0] : y[1];
}

/// Three components.
struct Vectors {
  Floats x, y, z;
};
SHAKEN_LANES Vectors load(const float (*from)[kLanes]) { return {load(from[0]), load(from[1]), load(from[2])}; }
SHAKEN_LANES Floats dot(const Vectors& a, const Vectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Sum of the components' sizes.
SHAKEN_LANES Floats size1(const Vectors& a) { return abs(a.x) + abs(a.y) + abs(a.z); }

#undef SHAKEN_LANES

}  // namespace shaken::lanes
