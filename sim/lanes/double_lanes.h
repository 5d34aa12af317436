#pragma once

#include <cmath>
#include <cstdint>

#include "sim/lanes/lanes.h"

/// Doubles that are computed with several at a time, for trajectories: in every lane, the operations of the scalar code
/// in its order, none of them fused, hence the same bits at every width and on every machine.
///
/// Conditions are numbers whose sign tells, and `larger` and `smaller` join them: g++ 12 takes apart what is done with
/// the results of comparisons, unless each is used up by one `? :` between values.
namespace shaken::lanes {

/// Doubles are handled so many at a time: the widest vector's worth.
inline constexpr int kDoubleLanes = 8;

template <int W>
struct DoubleVector {
  typedef double Doubles __attribute__((vector_size(W * sizeof(double))));
  typedef std::int64_t Masks __attribute__((vector_size(W * sizeof(std::int64_t))));
};
template <int W>
using Doubles = typename DoubleVector<W>::Doubles;

/// x in every lane.
template <int W>
SHAKEN_INLINE Doubles<W> all(double x) {
  return Doubles<W>{} + x;
}
template <int W>
SHAKEN_INLINE Doubles<W> load(const double* from) {
  Doubles<W> x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}
template <class D>
SHAKEN_INLINE void store(double* to, const D& x) {
  __builtin_memcpy(to, &x, sizeof x);
}
template <class D>
SHAKEN_INLINE D absolute(const D& x) {
  using Masks = typename DoubleVector<sizeof(D) / sizeof(double)>::Masks;
  return reinterpret_cast<D>(reinterpret_cast<Masks>(x) & 0x7fffffffffffffff);
}
/// `then` where `condition` is above zero, `otherwise` elsewhere.
template <class D>
SHAKEN_INLINE D where_positive(const D& condition, const D& then, const D& otherwise) {
  return condition > 0.0 ? then : otherwise;
}
template <class D>
SHAKEN_INLINE D square_root(const D& x) {
  constexpr int W = sizeof(D) / sizeof(double);
  D root;
  for (int l = 0; l < W; ++l) root[l] = std::sqrt(x[l]);
  return root;
}

/// Three components, which add up as those of Vec3 do.
template <class D>
struct Triple {
  D x, y, z;

  SHAKEN_INLINE D dot(const Triple& b) const { return x * b.x + (y * b.y + z * b.z); }
  SHAKEN_INLINE D squared_norm() const { return dot(*this); }
  SHAKEN_INLINE Triple cross(const Triple& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
};
template <class D>
SHAKEN_INLINE Triple<D> operator+(const Triple<D>& a, const Triple<D>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class D>
SHAKEN_INLINE Triple<D> operator-(const Triple<D>& a, const Triple<D>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class D>
SHAKEN_INLINE Triple<D> operator*(const D& s, const Triple<D>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class D>
SHAKEN_INLINE Triple<D> operator/(const Triple<D>& a, const D& s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class D>
SHAKEN_INLINE Triple<D> where_positive(const D& condition, const Triple<D>& then, const Triple<D>& otherwise) {
  return {where_positive(condition, then.x, otherwise.x), where_positive(condition, then.y, otherwise.y),
          where_positive(condition, then.z, otherwise.z)};
}

/// Triples of kDoubleLanes things, component by component.
struct TripleLanes {
  alignas(64) double x[kDoubleLanes];
  alignas(64) double y[kDoubleLanes];
  alignas(64) double z[kDoubleLanes];

  template <class Vector>
  void set(int lane, const Vector& v) {
    x[lane] = v.x();
    y[lane] = v.y();
    z[lane] = v.z();
  }
  template <class Vector>
  void get(int lane, Vector& v) const {
    v.x() = x[lane];
    v.y() = y[lane];
    v.z() = z[lane];
  }
  template <int W>
  SHAKEN_INLINE Triple<Doubles<W>> load(int l) const {
    return {lanes::load<W>(x + l), lanes::load<W>(y + l), lanes::load<W>(z + l)};
  }
  template <class D>
  SHAKEN_INLINE void store(int l, const Triple<D>& v) {
    lanes::store(x + l, v.x);
    lanes::store(y + l, v.y);
    lanes::store(z + l, v.z);
  }
};
namespace detail {

#if defined(__x86_64__)
template <class Kernel>
[[gnu::target("avx512f"), gnu::noinline]] auto run_exactly_8(const Kernel& kernel) {
  return kernel.template run<8>();
}
template <class Kernel>
[[gnu::target("avx2"), gnu::noinline]] auto run_exactly_4(const Kernel& kernel) {
  return kernel.template run<4>();
}
#endif

}  // namespace detail

/// kernel.run<W>(), with W the number of doubles in this machine's vectors. `run` must be SHAKEN_INLINE.
template <class Kernel>
auto with_widest_doubles(const Kernel& kernel) {
#if defined(__x86_64__)
  if (detail::machine_width == 16) return detail::run_exactly_8(kernel);
  if (detail::machine_width == 8) return detail::run_exactly_4(kernel);
#endif
  return kernel.template run<2>();
}

}  // namespace shaken::lanes
