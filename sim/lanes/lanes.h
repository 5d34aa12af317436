#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#if defined(__x86_64__) && !defined(__clang__)
#include <immintrin.h>
#define SHAKEN_X86_BUILTINS 1
#endif

/// Floats that are computed with several at a time, in the compiler's own vectors, and the choice of how many: one
/// program runs on any x86-64 and uses what the machine has. For bounds and filters, whose results decide where to look
/// and never what is found: their last bits may differ between machines.
///
/// A kernel is a template over the number of lanes W, with every function in it inlined by force, so that it becomes
/// part of a caller that is compiled for that width (with_widest_vectors).

// Vectors go from function to function in registers here or, where a function is not inlined, all is lost: the warning
// that it would then be done differently on other machines is beside the point.
#pragma GCC diagnostic ignored "-Wpsabi"

#define SHAKEN_INLINE [[gnu::always_inline]] inline

namespace shaken::lanes {

/// Bounds are made for so many things in one go: the widest vector's worth.
inline constexpr int kLanes = 16;

template <int W>
struct Vector {
  // as typedefs: g++ 12 drops the attribute from an alias that depends on W
  typedef float Floats __attribute__((vector_size(W * sizeof(float))));
  typedef std::int32_t Ints __attribute__((vector_size(W * sizeof(std::int32_t))));
};
template <int W>
using Floats = typename Vector<W>::Floats;
template <int W>
using Ints = typename Vector<W>::Ints;

/// x in every lane.
template <int W>
SHAKEN_INLINE Floats<W> all(float x) {
  return Floats<W>{} + x;
}
template <int W>
SHAKEN_INLINE Floats<W> load(const float* from) {
  Floats<W> x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}
template <class F>
SHAKEN_INLINE void store(float* to, const F& x) {
  __builtin_memcpy(to, &x, sizeof x);
}

template <class F>
inline constexpr int width = sizeof(F) / sizeof(float);

template <class F, int W>
inline constexpr bool are_floats = std::is_same_v<F, Floats<W>>;

// g++ 12 compares and blends, or joins lanes one by one, where the machine has an instruction that gives the same.

template <class F>
SHAKEN_INLINE F larger(const F& a, const F& b) {
#ifdef SHAKEN_X86_BUILTINS
  if constexpr (are_floats<F, 16>) return __builtin_ia32_maxps512_mask(a, b, F{}, -1, 4);
  if constexpr (are_floats<F, 8>) return __builtin_ia32_maxps256(a, b);
  if constexpr (are_floats<F, 4>) return __builtin_ia32_maxps(a, b);
#endif
  return a > b ? a : b;
}
template <class F>
SHAKEN_INLINE F smaller(const F& a, const F& b) {
#ifdef SHAKEN_X86_BUILTINS
  if constexpr (are_floats<F, 16>) return __builtin_ia32_minps512_mask(a, b, F{}, -1, 4);
  if constexpr (are_floats<F, 8>) return __builtin_ia32_minps256(a, b);
  if constexpr (are_floats<F, 4>) return __builtin_ia32_minps(a, b);
#endif
  return a < b ? a : b;
}
template <class F>
SHAKEN_INLINE F not_below_zero(const F& a) {
  return larger(a, F{});
}
template <class F>
SHAKEN_INLINE F clamp(const F& x, const F& limit) {
  return larger(-limit, smaller(limit, x));
}
template <class F>
SHAKEN_INLINE F abs(const F& x) {
  using I = Ints<width<F>>;
  return reinterpret_cast<F>(reinterpret_cast<I>(x) & 0x7fffffff);
}
/// |size|, with the sign of `sign`.
template <class F>
SHAKEN_INLINE F with_sign_of(const F& size, const F& sign) {
  using I = Ints<width<F>>;
  return reinterpret_cast<F>((reinterpret_cast<I>(size) & 0x7fffffff) |
                             (reinterpret_cast<I>(sign) & static_cast<std::int32_t>(0x80000000)));
}
/// a - b in every lane, modulo 2^32.
template <int W>
SHAKEN_INLINE Ints<W> difference(const Ints<W>& a, std::int32_t b) {
  typedef std::uint32_t Unsigned __attribute__((vector_size(W * sizeof(std::uint32_t))));
  return reinterpret_cast<Ints<W>>(reinterpret_cast<Unsigned>(a) - static_cast<std::uint32_t>(b));
}
/// Towards zero; |x| < 2^31.
template <class F>
SHAKEN_INLINE F truncated(const F& x) {
  return __builtin_convertvector(__builtin_convertvector(x, Ints<width<F>>), F);
}
template <class F>
SHAKEN_INLINE F sqrt(const F& x) {
  F root;
  for (int l = 0; l < width<F>; ++l) root[l] = std::sqrt(x[l]);
  return root;
}
namespace detail {
/// All lanes joined to one, half with half; `Join` has the function `of`.
template <class Join, class F>
SHAKEN_INLINE float joined(const F& x) {
  constexpr int W = width<F>;
  if constexpr (W == 1) {
    return x[0];
  } else {
    Floats<W / 2> half[2];
    __builtin_memcpy(half, &x, sizeof x);
    return joined<Join>(Join::of(half[0], half[1]));
  }
}
struct Smaller {
  template <class F>
  SHAKEN_INLINE static F of(const F& a, const F& b) {
    return smaller(a, b);
  }
};
}  // namespace detail
/// The least of all lanes.
template <class F>
SHAKEN_INLINE float least(const F& x) {
  return detail::joined<detail::Smaller>(x);
}
/// A bit for each lane, the first one lowest: whether it is below zero.
template <class F>
SHAKEN_INLINE std::uint32_t below_zero(const F& x) {
#ifdef SHAKEN_X86_BUILTINS
  constexpr int kLess = 17;  // false for NaN
  if constexpr (are_floats<F, 16>) {
    return static_cast<std::uint16_t>(__builtin_ia32_cmpps512_mask(x, F{}, kLess, -1, 4));
  }
  if constexpr (are_floats<F, 8>) return __builtin_ia32_movmskps256(reinterpret_cast<F>(x < 0.0F));
  if constexpr (are_floats<F, 4>) return __builtin_ia32_movmskps(reinterpret_cast<F>(x < 0.0F));
#endif
  std::uint32_t bits = 0;
  for (int l = 0; l < width<F>; ++l) bits |= (x[l] < 0.0F ? 1U : 0U) << l;
  return bits;
}
/// The same, whether it is not above zero.
template <class F>
SHAKEN_INLINE std::uint32_t not_above_zero(const F& x) {
  return below_zero(F(-x)) ^ ((1U << width<F>)-1U);
}

/// Three components.
template <class F>
struct Vectors {
  F x, y, z;
};
template <int W>
SHAKEN_INLINE Vectors<Floats<W>> load(const float (*from)[kLanes], int l) {
  return {load<W>(from[0] + l), load<W>(from[1] + l), load<W>(from[2] + l)};
}
template <class F>
SHAKEN_INLINE F dot(const Vectors<F>& a, const Vectors<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Sum of the components' sizes.
template <class F>
SHAKEN_INLINE F size1(const Vectors<F>& a) {
  return abs(a.x) + abs(a.y) + abs(a.z);
}

// ---- the machine's width

namespace detail {

inline int widest() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return 16;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 8;
#endif
  return 4;
}
/// Tests narrow it. Other processors than x86-64 have one width, and there it stays what it is.
inline int machine_width = widest();

#if defined(__x86_64__)
// Multiply and add may be fused here, and only here: trajectories are computed elsewhere. To clang that is a property
// of the text of a function, not of what it is inlined into, so that its builds do without.
#if defined(__clang__)
#define SHAKEN_MAY_FUSE
#else
#define SHAKEN_MAY_FUSE [[gnu::optimize("fp-contract=fast")]]
#endif

template <class Kernel>
SHAKEN_MAY_FUSE [[gnu::target("avx512f,fma"), gnu::noinline]] auto run_16(const Kernel& kernel) {
  return kernel.template run<16>();
}
template <class Kernel>
SHAKEN_MAY_FUSE [[gnu::target("avx2,fma"), gnu::noinline]] auto run_8(const Kernel& kernel) {
  return kernel.template run<8>();
}
#endif

}  // namespace detail

/// kernel.run<W>(), with W the number of floats in this machine's vectors. `run` must be SHAKEN_INLINE.
template <class Kernel>
auto with_widest_vectors(const Kernel& kernel) {
#if defined(__x86_64__)
  if (detail::machine_width == 16) return detail::run_16(kernel);
  if (detail::machine_width == 8) return detail::run_8(kernel);
#endif
  return kernel.template run<4>();
}

}  // namespace shaken::lanes
