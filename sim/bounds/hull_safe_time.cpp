#include "sim/bounds/hull_safe_time.h"

#include <algorithm>

#include "sim/bounds/margins.h"

namespace shaken {
namespace {

/// Point of an axis (|s| <= h, leaning towards its thick middle) from which a point at `foot` along and `across`
/// beside it is nearest, measured from the hull's surface.
template <class F>
SHAKEN_INLINE F nearest_on_axis(const F& half_length, float lean, const F& foot, const F& across) {
  return lanes::clamp(lanes::with_sign_of(lanes::not_below_zero(lanes::abs(foot) - lean * across), foot), half_length);
}

/// How much a director's component along a pair's direction can grow: |n . d| <= |c + w t| + (q t + b) t.
template <class F>
struct Cosine {
  F c, w, q, b;
  SHAKEN_INLINE F at(const F& t) const { return lanes::abs(c + w * t) + (q * t + b) * t; }
};

/// gap + rate t - width_i(t) - width_j(t)
template <class F>
struct Gap {
  const Hull& i;
  const Hull& j;
  F gap, rate;
  Cosine<F> cosine_i, cosine_j;

  SHAKEN_INLINE F at(const F& t) const {
    return gap + rate * t - i.half_length * lanes::not_below_zero(cosine_i.at(t) - i.taper) -
           j.half_length * lanes::not_below_zero(cosine_j.at(t) - j.taper);
  }
  struct Safe {
    F start;  ///< the gap now
    F time;   ///< for which it certainly stays positive
    F end;    ///< the gap by then
  };
  SHAKEN_INLINE Safe safe_time(float horizon) const {
    F safe{};
    F beyond = safe + horizon;
    F gap_safe = at(safe);
    F gap_beyond = at(beyond);
    const F at_start = gap_safe;
    const F at_end = gap_beyond;
    for (int step = 0; step < 3; ++step) {
      const F t = safe + (beyond - safe) * (gap_safe / (gap_safe - gap_beyond + 1e-30F));
      const F gap_t = at(t);
      const auto inside = gap_t >= 0.0F;  // not so only by rounding: the chord of a concave function lies below it
      safe = inside ? t : safe;
      gap_safe = inside ? gap_t : gap_safe;
      beyond = inside ? beyond : t;
      gap_beyond = inside ? gap_beyond : gap_t;
    }
    safe = at_end >= 0.0F ? F{} + horizon : safe;
    return {at_start, at_start > 0.0F ? safe : F{}, at_end >= 0.0F ? at_end : gap_safe};
  }
};

struct HullKernel {
  const Hull& i;
  const Hull& j;
  const PairLanes& pairs;
  int n;
  float horizon;
  HullSafeTimes& safe;

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < n; l += W) bound<W>(l);
  }

  template <int W>
  SHAKEN_INLINE void bound(int l) const {
    using F = lanes::Floats<W>;
    using V = lanes::Vectors<F>;
    const V D = lanes::load<W>(pairs.D, l);
    const V n_i = lanes::load<W>(pairs.director_i, l);
    const V n_j = lanes::load<W>(pairs.director_j, l);
    const V d = direction<W>(D, n_i, n_j);
    const typename Gap<F>::Safe bound = gap_along<W>(d, l, D, n_i, n_j).safe_time(horizon);
    lanes::store(safe.direction[0] + l, d.x);
    lanes::store(safe.direction[1] + l, d.y);
    lanes::store(safe.direction[2] + l, d.z);
    lanes::store(safe.time + l, bound.time);
    lanes::store(safe.gap + l, bound.start);
    lanes::store(safe.gap_at_end + l, bound.end);
  }

  /// Between points s on the axis of i and t on that of j that are nearly closest to each other; up if those coincide.
  template <int W, class V>
  SHAKEN_INLINE V direction(const V& D, const V& n_i, const V& n_j) const {
    using F = lanes::Floats<W>;
    const float lean_i = i.taper / std::sqrt(std::max(1e-12F, 1.0F - i.taper * i.taper));
    const float lean_j = j.taper / std::sqrt(std::max(1e-12F, 1.0F - j.taper * j.taper));
    const F h_i = lanes::all<W>(i.half_length);
    const F h_j = lanes::all<W>(j.half_length);
    // distances between points of the axes follow from products of the inputs
    const F c = lanes::dot(n_i, n_j);
    const F d_i = lanes::dot(D, n_i);
    const F d_j = lanes::dot(D, n_j);
    const F D2 = lanes::dot(D, D);
    const F det = 1.0F - c * c;
    F s = lanes::clamp(det > 1e-5F ? (d_i - c * d_j) / det : 0.5F * d_i, h_i);
    F t{};
    for (int pass = 0; pass < 2; ++pass) {
      const F foot_j = c * s - d_j;
      const F across_j = lanes::sqrt(lanes::not_below_zero(D2 + s * (s - 2.0F * d_i) - foot_j * foot_j));
      t = nearest_on_axis(h_j, lean_j, foot_j, across_j);
      const F foot_i = d_i + c * t;
      const F across_i = lanes::sqrt(lanes::not_below_zero(D2 + t * (t + 2.0F * d_j) - foot_i * foot_i));
      s = nearest_on_axis(h_i, lean_i, foot_i, across_i);
    }
    V d{D.x + t * n_j.x - s * n_i.x, D.y + t * n_j.y - s * n_i.y, D.z + t * n_j.z - s * n_i.z};
    const F distance2 = lanes::dot(d, d);
    const auto apart = distance2 > 1e-12F;
    const F scale = 1.0F / lanes::sqrt(apart ? distance2 : lanes::all<W>(1.0F));
    d.x = apart ? d.x * scale : F{};
    d.y = apart ? d.y * scale : F{};
    d.z = apart ? d.z * scale : lanes::all<W>(1.0F);
    return d;
  }

  /// The gap along d as a function of time, less all that rounding may have added.
  template <int W, class V>
  SHAKEN_INLINE Gap<lanes::Floats<W>> gap_along(const V& d, int l, const V& D, const V& n_i, const V& n_j) const {
    using F = lanes::Floats<W>;
    const V v = lanes::load<W>(pairs.velocity, l);
    const F gap = lanes::dot(D, d) - (i.mid_radius + j.mid_radius + margins::kHullRadius) -
                  margins::kHullLength * (lanes::sqrt(lanes::dot(D, D)) + (i.half_length + j.half_length));
    const F rate_margin =
        margins::kHullSpeed + lanes::load<W>(pairs.velocity_rounding + l) + margins::kHullRate * lanes::size1(v);
    const auto cosine = [&](const V& director, const V& turning, const float* half_rate2)
        __attribute__((always_inline)) {
      return Cosine<F>{lanes::dot(director, d), lanes::dot(turning, d), lanes::load<W>(half_rate2 + l),
                       margins::kHullRate * lanes::size1(turning)};
    };
    return {i,
            j,
            gap,
            lanes::dot(v, d) - rate_margin,
            cosine(n_i, lanes::load<W>(pairs.turning_i, l), pairs.half_rate2_i),
            cosine(n_j, lanes::load<W>(pairs.turning_j, l), pairs.half_rate2_j)};
  }
};

}  // namespace

void PairLanes::set(int lane, const Vec3& D_ij, const FlightBound& i, const FlightBound& j) {
  for (int c = 0; c < 3; ++c) {
    D[c][lane] = static_cast<float>(D_ij[c]);
    director_i[c][lane] = i.director[c];
    director_j[c][lane] = j.director[c];
    turning_i[c][lane] = i.turning[c];
    turning_j[c][lane] = j.turning[c];
    velocity[c][lane] = j.velocity[c] - i.velocity[c];
  }
  velocity_rounding[lane] = i.velocity_rounding + j.velocity_rounding;
  half_rate2_i[lane] = i.half_rate2;
  half_rate2_j[lane] = j.half_rate2;
}

void hull_safe_times(const Hull& i, const Hull& j, const PairLanes& pairs, int n, float horizon, HullSafeTimes& safe) {
  lanes::with_widest_vectors(HullKernel{i, j, pairs, n, horizon, safe});
}

}  // namespace shaken
