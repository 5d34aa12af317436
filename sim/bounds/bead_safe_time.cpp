#include "sim/bounds/bead_safe_time.h"

#include <algorithm>
#include <bit>

#include "sim/bounds/margins.h"

namespace shaken {
namespace {

/// What the lanes share: everything relative to the centre of rod i, as floats.
struct Shared {
  float D[3], n_i[3], n_j[3];
  float gap_margin;
  float place_rounding;  ///< what places of beads relative to each other may be wrong by [mm]
};

/// How two rods move relative to each other.
struct Relative {
  float v[3], turn_i[3], turn_j[3];
  float bend_i, bend_j;  ///< halves of the bounds on the directors' second derivatives
  float rounding;        ///< what speeds may be wrong by
  float fastest;         ///< no two beads approach faster than this
  float turned;          ///< how fast that speed times the distance goes wrong where the line between beads does
};

/// Vectors from beads of i to the centre of j.
template <class F>
SHAKEN_INLINE lanes::Vectors<F> to_center(const Shared& in, const F& offset_i) {
  return {in.D[0] - offset_i * in.n_i[0], in.D[1] - offset_i * in.n_i[1], in.D[2] - offset_i * in.n_i[2]};
}

/// Index of the last bead of j before a coordinate on its axis.
template <class F>
SHAKEN_INLINE F bead_before(const BeadLanes& j, const F& foot) {
  const F place = (foot - j.first_offset) * (1.0F / j.pitch);
  return lanes::truncated(lanes::smaller(lanes::larger(place, F{}), F{} + j.last_index));
}

/// Square of how far points at x are beside an axis on which their feet are, or less: the difference of two squares
/// loses what they are rounded by.
template <class F>
SHAKEN_INLINE F across_squared(const lanes::Vectors<F>& x, const F& foot) {
  return lanes::not_below_zero(lanes::dot(x, x) * (1.0F - margins::kSquares) - foot * foot);
}

/// How far a coordinate on the axis of j is beyond its end; 0 within it.
template <class F>
SHAKEN_INLINE F beyond_end(const BeadLanes& j, const F& foot) {
  return lanes::not_below_zero(lanes::larger(foot - j.last_offset, j.first_offset - foot));
}

/// How far apart beads of i and the hull of j are at least: the hull is the spheres of radius mid_radius - taper |s|,
/// and sqrt(across^2 + (foot - s)^2) + taper |s| is never less than cos across + taper |foot|, with taper the sine.
template <class F>
SHAKEN_INLINE F gap_to_hull(const BeadLanes& j, const F& radius, const F& foot, const F& across2) {
  const F outside = beyond_end(j, foot);
  const F along = lanes::abs(foot) - outside;
  return j.sure_cosine * lanes::sqrt(across2 + outside * outside) + j.sure_taper * along - j.max_radius - radius;
}

/// Radius of the hull of j at a coordinate on its axis: that of a bead there, or more.
template <class F>
SHAKEN_INLINE F hull_radius(const BeadLanes& j, const F& s) {
  return j.mid_radius - j.taper * lanes::abs(s) - j.skew * s;
}

/// The beads of j that are not tried next to a foot on its axis, seen from there: how far along the axis the nearest
/// can be, at least, and how thick, at most. Further ones are thicker at most by the steepest taper, which is less than
/// what they are further away, unless the foot is very far beside the axis: `untried_width` is as far as counts.
template <class F>
struct Untried {
  F along, radius;
  SHAKEN_INLINE Untried(const BeadLanes& j, const F& foot) {
    const F inside = lanes::smaller(lanes::larger(foot, F{} + j.first_offset), F{} + j.last_offset);
    along = lanes::abs(foot - inside) + j.untried_from;
    radius = lanes::larger(hull_radius(j, lanes::larger(inside - j.untried_from, F{} + j.first_offset)),
                           hull_radius(j, lanes::smaller(inside + j.untried_from, F{} + j.last_offset)));
    radius = lanes::larger(radius, F{} + j.untried_radius);
  }
  SHAKEN_INLINE F distance2(const BeadLanes& j, const F& across2) const {
    return lanes::smaller(across2, F{} + j.untried_width * j.untried_width) + along * along;
  }
};

/// Coordinate of the k-th bead of j after `before`, or of the last one that there is.
template <class F>
SHAKEN_INLINE F bead_offset(const BeadLanes& j, const F& before, int k) {
  const F index = lanes::smaller(lanes::larger(before + static_cast<float>(k), F{}), F{} + j.last_index);
  return index * j.pitch + j.first_offset;
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

/// Which of the beads of i may overlap a bead of j.
struct OverlapKernel {
  const Shared& in;
  const BeadLanes& i;
  const BeadLanes& j;

  template <int W>
  SHAKEN_INLINE BeadRange run() const {
    BeadRange beads;
    for (int l = 0; l < i.n_lanes(); l += W) {
      const BeadRange some = find<W>(l);
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
    const F radius = lanes::load<W>(i.radius.data() + bead) + in.gap_margin;
    const F across2 = across_squared(x, foot);
    if (lanes::not_above_zero(gap_to_hull(j, radius, foot, across2)) == 0) return {};
    const F before = bead_before(j, foot);
    const Untried<F> untried(j, foot);
    const F cut = lanes::not_below_zero(radius + untried.radius);
    F clear = untried.distance2(j, across2) - cut * cut;
    for (int k = j.first_tried; k <= j.last_tried; ++k) {
      const F s_j = bead_offset(j, before, k);
      const lanes::Vectors<F> r{x.x + s_j * in.n_j[0], x.y + s_j * in.n_j[1], x.z + s_j * in.n_j[2]};
      const F touch = lanes::not_below_zero(radius + hull_radius(j, s_j));
      clear = lanes::smaller(clear, lanes::dot(r, r) - touch * touch);
    }
    const std::uint32_t meet = lanes::not_above_zero(clear);
    if (meet == 0) return {};
    return {bead + std::countr_zero(meet), bead + 32 - std::countl_zero(meet)};
  }
};

/// How beads of i and those of j at a distance m past the bead before their feet approach each other. Their centres are
/// r = r_0 + m n_j apart, and their distance grows by rate |r| = (v_0 + m n_j') . (r_0 + m n_j): a polynomial in m.
template <class F>
struct Approach {
  F r2, along;  ///< r_0 . r_0, r_0 . n_j
  F rate_0, rate_1;
  float rate_2;

  SHAKEN_INLINE Approach(const Shared& in, const Relative& motion, const lanes::Vectors<F>& x, const F& s_i,
                         const F& s_0) {
    const lanes::Vectors<F> r{x.x + s_0 * in.n_j[0], x.y + s_0 * in.n_j[1], x.z + s_0 * in.n_j[2]};
    r2 = lanes::dot(r, r);
    along = r.x * in.n_j[0] + r.y * in.n_j[1] + r.z * in.n_j[2];
    const lanes::Vectors<F> v{motion.v[0] + s_0 * motion.turn_j[0] - s_i * motion.turn_i[0],
                              motion.v[1] + s_0 * motion.turn_j[1] - s_i * motion.turn_i[1],
                              motion.v[2] + s_0 * motion.turn_j[2] - s_i * motion.turn_i[2]};
    rate_0 = lanes::dot(v, r);
    rate_1 = v.x * in.n_j[0] + v.y * in.n_j[1] + v.z * in.n_j[2] + r.x * motion.turn_j[0] + r.y * motion.turn_j[1] +
             r.z * motion.turn_j[2];
    rate_2 = motion.turn_j[0] * in.n_j[0] + motion.turn_j[1] * in.n_j[1] + motion.turn_j[2] * in.n_j[2];
  }
  SHAKEN_INLINE F distance(const F& m) const {
    return lanes::sqrt(lanes::larger(r2 + m * (2.0F * along + m), F{} + 1e-30F));
  }
  SHAKEN_INLINE F rate_times_distance(const F& m) const { return rate_0 + m * (rate_1 + m * rate_2); }
};

/// Safe time of the beads of i against the beads of j around each one's foot on j's axis. Beads that are too far away
/// to be first are left out, a vector of them at a time.
///
/// Everything is multiplied by the distance of the beads, which saves a division. With a gap,
///     gap(t) >= gap + rate t - curvature t^2, where t^2 <= horizon t;
/// overlapping, rate(t) >= rate - 2 curvature t.
struct SafeTimeKernel {
  const Shared& in;
  const Relative& motion;
  const BeadLanes& i;
  const BeadLanes& j;
  float horizon;

  template <int W>
  SHAKEN_INLINE BeadSafeTime run() const {
    BeadSafeTime safe{horizon, 1e3F};
    if (i.n_lanes() <= W) {  // a single vector: none can be left out
      const BeadSafeTime all = bound<W>(0);
      return {std::min(safe.time, all.time), std::min(safe.gap, all.gap)};
    }
    float away[(kMostBeads + kLanes - 1) / kLanes * kLanes / W];
    int n_vectors = 0;
    for (int l = 0; l < i.n_lanes(); l += W) away[n_vectors++] = least_gap_to_hull<W>(l);
    for (int done = 0; done < n_vectors; ++done) {
      const int next = static_cast<int>(std::min_element(away, away + n_vectors) - away);
      if (away[next] > motion.fastest * safe.time) {
        safe.gap = std::min(safe.gap, away[next]);
        break;
      }
      const BeadSafeTime some = bound<W>(next * W);
      safe.time = std::min(safe.time, some.time);
      safe.gap = std::min(safe.gap, some.gap);
      away[next] = 1e9F;
    }
    return safe;
  }

  template <int W>
  SHAKEN_INLINE float least_gap_to_hull(int bead) const {
    using F = lanes::Floats<W>;
    const F radius = lanes::load<W>(i.radius.data() + bead) + in.gap_margin;
    const lanes::Vectors<F> x = to_center(in, lanes::load<W>(i.offset.data() + bead));
    const F foot = -(x.x * in.n_j[0] + x.y * in.n_j[1] + x.z * in.n_j[2]);
    return lanes::least(gap_to_hull(j, radius, foot, across_squared(x, foot)));
  }

  template <int W>
  SHAKEN_INLINE BeadSafeTime bound(int bead) const {
    using F = lanes::Floats<W>;
    const F s_i = lanes::load<W>(i.offset.data() + bead);
    const F radius = lanes::load<W>(i.radius.data() + bead) + in.gap_margin;
    const lanes::Vectors<F> x = to_center(in, s_i);
    const F foot = -(x.x * in.n_j[0] + x.y * in.n_j[1] + x.z * in.n_j[2]);
    const F before = bead_before(j, foot);
    const Untried<F> untried(j, foot);
    const F across2 = across_squared(x, foot);
    const F far = lanes::not_below_zero(lanes::sqrt(untried.distance2(j, across2)) - radius - untried.radius);
    F least_gap = far;
    Fraction<F> safe{far, lanes::all<W>(motion.fastest)};

    const F s_0 = bead_offset(j, before, 0);
    const Approach<F> approach(in, motion, x, s_i, s_0);
    const F bend_i = lanes::abs(s_i) * motion.bend_i;
    for (int k = j.first_tried; k <= j.last_tried; ++k) {
      const F s_j = bead_offset(j, before, k);
      const F m = s_j - s_0;
      const F distance = approach.distance(m);
      const F gap = distance - (radius + hull_radius(j, s_j));
      const F rate = approach.rate_times_distance(m) - (motion.rounding * distance + motion.turned);
      const F curvature = bend_i + lanes::abs(s_j) * motion.bend_j;
      const F gap_times_distance = gap * distance;
      const F closing = lanes::not_below_zero(curvature * horizon * distance - rate);
      least_gap = lanes::smaller(least_gap, gap);
      if (lanes::not_above_zero(gap) == 0) {
        safe.take_smaller(gap_times_distance, closing);
      } else {
        const auto apart = gap > 0.0F;
        safe.take_smaller(apart ? gap_times_distance : lanes::not_below_zero(rate),
                          apart ? closing : (2.0F * curvature + margins::kReceding) * distance);
      }
    }
    return {safe.least(), lanes::least(least_gap)};
  }
};

float norm(const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Shared shared(const BeadLanes& i, const float* n_i, const BeadLanes& j, const float* n_j, const Vec3& D) {
  Shared in;
  set_vector(in.D, D);
  std::copy_n(n_i, 3, in.n_i);
  std::copy_n(n_j, 3, in.n_j);
  const float size = norm(in.D) + i.half_length + j.half_length;
  in.gap_margin = margins::kBeadGap * (1.0F + size);
  in.place_rounding = margins::kBeadPlace * size;
  return in;
}

Relative relative(const BeadLanes& i, const FlightBound& a, const BeadLanes& j, const FlightBound& b,
                  float place_rounding) {
  Relative motion;
  for (int c = 0; c < 3; ++c) {
    motion.v[c] = b.velocity[c] - a.velocity[c];
    motion.turn_i[c] = a.turning[c];
    motion.turn_j[c] = b.turning[c];
  }
  motion.bend_i = a.half_rate2;
  motion.bend_j = b.half_rate2;
  // |turning| never exceeds the precession's rate
  const float fastest = norm(motion.v) + i.half_length * (std::sqrt(2.0F * a.half_rate2)) +
                        j.half_length * (std::sqrt(2.0F * b.half_rate2)) + margins::kFastestSpeed;
  // each rod's own velocity was rounded before they were compared; of what is relative, floats carry 6e-8, and a dozen
  // roundings come together
  const float rounding = a.velocity_rounding + b.velocity_rounding;
  motion.rounding = margins::kBeadSpeed + rounding + margins::kBeadRate * fastest;
  motion.fastest = (fastest + rounding) * (1.0F + margins::kFastest);
  // in lines between beads that are short beside the rods, the rounding of places is large
  motion.turned = fastest * place_rounding;
  return motion;
}

}  // namespace

BeadLanes::BeadLanes(const Species& species)
    : half_length(static_cast<float>(species.half_length)),
      mid_radius(static_cast<float>(species.mid_radius)),
      max_radius(static_cast<float>(species.max_radius)),
      taper(static_cast<float>(0.5 * (species.taper(species.head) + species.taper(species.tail)))),
      skew(static_cast<float>(0.5 * (species.taper(species.head) - species.taper(species.tail)))),
      first_offset(static_cast<float>(species.bead_offset.front())),
      last_offset(static_cast<float>(species.bead_offset.back())),
      last_index(static_cast<float>(species.n_beads() - 1)),
      pitch(static_cast<float>(species.pitch())),
      last_tried(species.n_beads() > 1 ? static_cast<int>(std::ceil(1.1F * max_radius / pitch)) : 0),
      first_tried(std::min(0, 1 - last_tried)),
      untried_from(last_tried > 0 ? static_cast<float>(last_tried) * pitch : 1e3F) {
  // gap_to_hull looks at both ends alike
  if (taper > 0.0F && taper < 1.0F && species.tail.length == species.head.length && skew == 0.0F) sure_taper = taper;
  sure_cosine = std::sqrt(1.0F - sure_taper * sure_taper);
  // a steeper taper than this would let `untried_width` fall to where rods touch
  const float steepest = std::abs(taper) + std::abs(skew);
  if (steepest < 0.3F) {
    if (steepest > 0.0F) untried_width = untried_from * std::sqrt(1.0F / (steepest * steepest) - 1.0F);
  } else {
    untried_radius = max_radius;
  }
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
  BeadRange beads = lanes::with_widest_vectors(OverlapKernel{in, i, j});
  beads.to = std::min(beads.to, static_cast<int>(i.last_index) + 1);  // lanes past the last bead hold none
  return beads;
}

BeadSafeTime bead_safe_time(const BeadLanes& i, const FlightBound& a, const BeadLanes& j, const FlightBound& b,
                            const Vec3& D, float horizon) {
  const Shared in = shared(i, a.director, j, b.director, D);
  const Relative motion = relative(i, a, j, b, in.place_rounding);
  const BeadSafeTime safe = lanes::with_widest_vectors(SafeTimeKernel{in, motion, i, j, horizon});
  return {safe.time * (1.0F - margins::kTime), safe.gap};
}

}  // namespace shaken
