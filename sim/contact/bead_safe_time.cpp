// SPDX-License-Identifier: MIT
#include "sim/contact/bead_safe_time.h"

#include <algorithm>

namespace shaken {
namespace {

/// What the lanes share: everything relative to the centre of rod i, as floats.
struct Shared {
  float D[3], n_i[3], n_j[3];
  float gap_margin;
};

/// How two rods move relative to each other: unperturbed, or perturbed by hits within their tolerance.
struct Relative {
  float v[3], turn_i[3], turn_j[3];
  float bend_i, bend_j;                  ///< halves of the bounds on the directors' second derivatives
  float drift, drift_z;                  ///< what the centres' relative velocity may drift by, across and along z
  float drift_turning, drift_turning_z;  ///< the same for each director's rate
  float fastest;                         ///< no two beads approach faster than this
};

/// Vectors from beads of i to the centre of j.
template <class F>
SHAKEN_INLINE lanes::Vectors<F> to_center(const Shared& in, const F& offset_i) {
  return {in.D[0] - offset_i * in.n_i[0], in.D[1] - offset_i * in.n_i[1], in.D[2] - offset_i * in.n_i[2]};
}

/// Index of the bead of j nearest to a coordinate on its axis.
template <class F>
SHAKEN_INLINE F nearest_bead(const BeadLanes& j, const F& foot) {
  const F place = (foot - j.first) * (1.0F / j.pitch);
  return lanes::truncated(lanes::smaller(lanes::larger(place, F{}), F{} + j.last) + 0.5F);
}

/// The beads of j that are not tried next to a foot on its axis, seen from there: how far along the axis the nearest
/// can be, at least, and how thick, at most. Further ones are thicker at most by the taper, which is less than what
/// they are further away, unless the foot is very far beside the axis: `widest` is as far as counts.
template <class F>
struct Untried {
  F along, radius;
  SHAKEN_INLINE Untried(const BeadLanes& j, const F& foot) {
    const F outside = lanes::not_below_zero(lanes::abs(foot) - j.half_length);
    along = outside + j.beyond;
    radius = j.max_radius - j.thinning * lanes::not_below_zero(lanes::abs(foot) - outside - j.beyond);
  }
  SHAKEN_INLINE F distance2(const BeadLanes& j, const F& across2) const {
    return lanes::smaller(across2, F{} + j.widest * j.widest) + along * along;
  }
};

/// Coordinate of the k-th bead of j after `nearest`, or of the last one that there is.
template <class F>
SHAKEN_INLINE F bead_offset(const BeadLanes& j, const F& nearest, int k) {
  const F index = lanes::smaller(lanes::larger(nearest + static_cast<float>(k), F{}), F{} + j.last);
  return index * j.pitch + j.first;
}

/// Radius of the hull of j at a coordinate on its axis: that of a bead there, or more.
template <class F>
SHAKEN_INLINE F hull_radius(const BeadLanes& j, const F& s) {
  return j.mid_radius - j.taper * lanes::abs(s) - j.skew * s;
}

/// A time as a fraction, so that the smallest of many is found without dividing.
template <class F>
struct Fraction {
  F above, below;  ///< neither negative; forever if `below` is 0
  SHAKEN_INLINE void take_smaller(const F& other_above, const F& other_below) {
    const auto other = other_above * below < above * other_below;
    above = other ? other_above : above;
    below = other ? other_below : below;
  }
  SHAKEN_INLINE float least() const { return lanes::least(above / (below + 1e-30F)); }
};

/// Takes the safe time of beads of i and of j at s_i and s_j, whose centres are r apart, into account: with a gap,
/// gap >= g + g' t - curvature t^2, where t^2 <= horizon t; overlapping, g' >= g'(0) - 2 curvature t.
template <class F>
SHAKEN_INLINE void take_safe_time(Fraction<F>& safe, const Relative& m, const F& s_i, const F& s_j,
                                  const lanes::Vectors<F>& r, const F& inverse_distance, const F& gap, float horizon) {
  const F vx = m.v[0] + s_j * m.turn_j[0] - s_i * m.turn_i[0];
  const F vy = m.v[1] + s_j * m.turn_j[1] - s_i * m.turn_i[1];
  const F vz = m.v[2] + s_j * m.turn_j[2] - s_i * m.turn_i[2];
  const F up = lanes::abs(r.z) * inverse_distance;
  const F size_i = lanes::abs(s_i);
  const F size_j = lanes::abs(s_j);
  const F drift = m.drift + m.drift_z * up + (size_i + size_j) * (m.drift_turning + m.drift_turning_z * up);
  const F rate = (vx * r.x + vy * r.y + vz * r.z) * inverse_distance - drift;
  const F curvature = size_i * m.bend_i + size_j * m.bend_j;
  const auto apart = gap > 0.0F;
  safe.take_smaller(apart ? gap : lanes::not_below_zero(rate),
                    apart ? lanes::not_below_zero(curvature * horizon - rate) : 2.0F * curvature + 1e-3F);
}

/// Which of the beads of i in the lanes from `first` on may overlap a bead of j.
struct OverlapKernel {
  const Shared& in;
  const BeadLanes& i;
  const BeadLanes& j;
  std::size_t first;

  template <int W>
  SHAKEN_INLINE BeadRange run() const {
    BeadRange beads;
    for (int l = 0; l < kLanes; l += W) {
      const BeadRange some = find<W>(static_cast<int>(first) + l);
      if (some.empty()) continue;
      if (beads.empty()) beads.from = some.from;
      beads.to = some.to;
    }
    return beads;
  }

  template <int W>
  SHAKEN_INLINE BeadRange find(int bead) const {
    using F = lanes::Floats<W>;
    const lanes::Vectors<F> x = to_center(in, lanes::load<W>(i.offset.data() + bead));
    const F foot = -(x.x * in.n_j[0] + x.y * in.n_j[1] + x.z * in.n_j[2]);
    const F nearest = nearest_bead(j, foot);
    const F radius = lanes::load<W>(i.radius.data() + bead) + in.gap_margin;
    const Untried<F> untried(j, foot);
    const F cut = lanes::not_below_zero(radius + untried.radius);
    F clear = untried.distance2(j, lanes::not_below_zero(lanes::dot(x, x) - foot * foot)) - cut * cut;
    for (int k = -j.reach; k <= j.reach; ++k) {
      const F s_j = bead_offset(j, nearest, k);
      const lanes::Vectors<F> r{x.x + s_j * in.n_j[0], x.y + s_j * in.n_j[1], x.z + s_j * in.n_j[2]};
      const F touch = lanes::not_below_zero(radius + hull_radius(j, s_j));
      clear = lanes::smaller(clear, lanes::dot(r, r) - touch * touch);
    }
    if (lanes::least(clear) > 0.0F) return {};
    BeadRange beads{bead, bead + W};
    while (clear[beads.from - bead] > 0.0F) ++beads.from;
    while (clear[beads.to - 1 - bead] > 0.0F) --beads.to;
    return beads;
  }
};

/// Safe times of the beads of i in the lanes from `first` on against the beads of j around each one's foot on j's axis.
struct SafeTimeKernel {
  const Shared& in;
  const Relative& unperturbed;
  const Relative& perturbed;
  const BeadLanes& i;
  const BeadLanes& j;
  std::size_t first;
  float horizon;

  template <int W>
  SHAKEN_INLINE SafeTime run() const {
    SafeTime safe{horizon, horizon};
    for (int l = 0; l < kLanes; l += W) {
      const SafeTime some = bound<W>(static_cast<int>(first) + l);
      safe.unperturbed = std::min(safe.unperturbed, some.unperturbed);
      safe.perturbed = std::min(safe.perturbed, some.perturbed);
    }
    return safe;
  }

  template <int W>
  SHAKEN_INLINE SafeTime bound(int bead) const {
    using F = lanes::Floats<W>;
    const F s_i = lanes::load<W>(i.offset.data() + bead);
    const F radius = lanes::load<W>(i.radius.data() + bead) + in.gap_margin;
    const lanes::Vectors<F> x = to_center(in, s_i);
    const F foot = -(x.x * in.n_j[0] + x.y * in.n_j[1] + x.z * in.n_j[2]);
    const F nearest = nearest_bead(j, foot);
    const Untried<F> untried(j, foot);
    const F across2 = lanes::not_below_zero(lanes::dot(x, x) - foot * foot);
    const F far = lanes::not_below_zero(lanes::sqrt(untried.distance2(j, across2)) - radius - untried.radius);
    Fraction<F> safe_unperturbed{far, lanes::all<W>(unperturbed.fastest)};
    Fraction<F> safe_perturbed{far, lanes::all<W>(perturbed.fastest)};
    for (int k = -j.reach; k <= j.reach; ++k) {
      const F s_j = bead_offset(j, nearest, k);
      const lanes::Vectors<F> r{x.x + s_j * in.n_j[0], x.y + s_j * in.n_j[1], x.z + s_j * in.n_j[2]};
      const F distance = lanes::sqrt(lanes::dot(r, r));
      const F inverse = 1.0F / (distance + 1e-20F);
      const F gap = distance - (radius + hull_radius(j, s_j));
      take_safe_time(safe_unperturbed, unperturbed, s_i, s_j, r, inverse, gap, horizon);
      take_safe_time(safe_perturbed, perturbed, s_i, s_j, r, inverse, gap, horizon);
    }
    return {safe_unperturbed.least(), safe_perturbed.least()};
  }
};

float norm(const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Shared shared(const BeadLanes& i, const float* n_i, const BeadLanes& j, const float* n_j, const Vec3& D) {
  Shared in;
  set_vector(in.D, D);
  std::copy_n(n_i, 3, in.n_i);
  std::copy_n(n_j, 3, in.n_j);
  in.gap_margin = 1e-6F * (1.0F + norm(in.D) + i.half_length + j.half_length);
  return in;
}

Relative relative(const BeadLanes& i, const BeadLanes& j, const float* v_i, const float* v_j, const float* turn_i,
                  const float* turn_j, float half_rate2_i, float half_rate2_j, const MotionTolerance& allow) {
  Relative m;
  for (int c = 0; c < 3; ++c) {
    m.v[c] = v_j[c] - v_i[c];
    m.turn_i[c] = turn_i[c];
    m.turn_j[c] = turn_j[c];
  }
  m.bend_i = half_rate2_i;
  m.bend_j = half_rate2_j;
  m.drift_z = 2.0F * allow.velocity_z;
  m.drift_turning = allow.turning_xy;
  m.drift_turning_z = allow.turning_z;
  // |turning| never exceeds the precession's rate
  const float fastest = norm(m.v) + i.half_length * (std::sqrt(2.0F * half_rate2_i)) +
                        j.half_length * (std::sqrt(2.0F * half_rate2_j)) +
                        2.0F * (allow.velocity_xy + allow.velocity_z) + 1e-3F;
  // floats carry 6e-8; a dozen roundings of speeds
  m.drift = 2.0F * allow.velocity_xy + 1e-6F + 3e-6F * fastest;
  m.fastest = fastest * 1.00001F;
  return m;
}

}  // namespace

BeadLanes::BeadLanes(const Species& species)
    : half_length(static_cast<float>(species.half_length)),
      mid_radius(static_cast<float>(species.mid_radius)),
      max_radius(static_cast<float>(species.max_radius)),
      taper(static_cast<float>(0.5 * (species.taper(species.head) + species.taper(species.tail)))),
      skew(static_cast<float>(0.5 * (species.taper(species.head) - species.taper(species.tail)))),
      first(static_cast<float>(species.bead_offset.front())),
      last(static_cast<float>(species.n_beads() - 1)),
      pitch(static_cast<float>(species.pitch())),
      reach(species.n_beads() > 1 ? static_cast<int>(std::ceil(1.1F * max_radius / pitch - 0.5F)) : 0),
      beyond((static_cast<float>(reach) + 0.5F) * pitch) {
  // a thinning of more than this would let `widest` fall to where rods touch; and Untried looks at both ends alike
  if (taper > 0.0F && taper < 0.3F && species.tail.length == species.head.length && skew == 0.0F) thinning = taper;
  widest = thinning > 0.0F ? beyond * std::sqrt(1.0F / (thinning * thinning) - 1.0F) : 1e6F;
  const int n_lanes = (species.n_beads() + kLanes - 1) / kLanes * kLanes;
  for (int lane = 0; lane < n_lanes; ++lane) {
    const bool is_bead = lane < species.n_beads();
    offset.push_back(is_bead ? static_cast<float>(species.bead_offset[lane]) : 0.0F);
    radius.push_back(is_bead ? static_cast<float>(species.bead_radius[lane]) : -1e3F);  // never near anything
  }
}

BeadRange beads_may_overlap(const BeadLanes& i, const Vec3& n_i, const BeadLanes& j, const Vec3& n_j, const Vec3& D) {
  float director_i[3], director_j[3];
  set_vector(director_i, n_i);
  set_vector(director_j, n_j);
  const Shared in = shared(i, director_i, j, director_j, D);
  BeadRange beads;
  for (std::size_t first = 0; first < i.offset.size(); first += kLanes) {
    const BeadRange some = lanes::with_widest_vectors(OverlapKernel{in, i, j, first});
    if (some.empty()) continue;
    if (beads.empty()) beads.from = some.from;
    beads.to = some.to;
  }
  beads.to = std::min(beads.to, static_cast<int>(i.last) + 1);  // lanes past the last bead hold none
  return beads;
}

SafeTime bead_safe_time(const BeadLanes& i, const MotionBound& a, const BeadLanes& j, const MotionBound& b,
                        const Vec3& D, const MotionTolerance& tolerance, float horizon) {
  const Shared in = shared(i, a.director, j, b.director, D);
  const Relative unperturbed =
      relative(i, j, a.velocity, b.velocity, a.turning, b.turning, a.half_rate2, b.half_rate2, MotionTolerance{});
  const Relative perturbed = relative(i, j, a.velocity_centre, b.velocity_centre, a.turning_centre, b.turning_centre,
                                      a.limit_half_rate2, b.limit_half_rate2, tolerance);
  SafeTime safe{horizon, horizon};
  for (std::size_t first = 0; first < i.offset.size(); first += kLanes) {
    const SafeTime some = lanes::with_widest_vectors(SafeTimeKernel{in, unperturbed, perturbed, i, j, first, horizon});
    safe.unperturbed = std::min(safe.unperturbed, some.unperturbed);
    safe.perturbed = std::min(safe.perturbed, some.perturbed);
  }
  return {safe.unperturbed * (1.0F - 1e-5F), safe.perturbed * (1.0F - 1e-5F)};
}

}  // namespace shaken
