// SPDX-License-Identifier: MIT
#include "sim/contact/bead_safe_time.h"

#include <algorithm>

#include "sim/core/vector_clones.h"

namespace shaken {
namespace {

using lanes::Floats;
using lanes::Vectors;

/// What the lanes share: everything relative to the centre of rod i, as floats.
struct Shared {
  float D[3], n_i[3], n_j[3];
  float gap_margin;
};

/// How two rods move relative to each other, within one of their sets of limits.
struct Relative {
  float v[3], turn_i[3], turn_j[3];
  float bend_i, bend_j;              ///< halves of the bounds on the directors' second derivatives
  float stray, stray_z;              ///< what the centres' relative velocity may stray by, across and along z
  float stray_turning, stray_turning_z;  ///< the same for each director's rate
  float fastest;                     ///< no two beads approach faster than this
};

/// Vectors from beads of i to the centre of j.
[[gnu::always_inline]] inline Vectors to_center(const Shared& in, const Floats& offset_i) {
  return {in.D[0] - offset_i * in.n_i[0], in.D[1] - offset_i * in.n_i[1], in.D[2] - offset_i * in.n_i[2]};
}

/// Index of the bead of j nearest to a coordinate on its axis.
[[gnu::always_inline]] inline Floats nearest_bead(const BeadLanes& j, const Floats& foot) {
  const Floats place = (foot + j.half_length) * (1.0F / j.pitch);
  return lanes::truncated(lanes::smaller(lanes::larger(place, Floats{}), lanes::all(j.last)) + 0.5F);
}

/// The beads of j that are not tried next to a foot on its axis, seen from there: how far along the axis the nearest
/// can be, at least, and how thick, at most. Further ones are thicker at most by the taper, which is less than what
/// they are further away, unless the foot is very far beside the axis: `widest` is as far as counts.
struct Untried {
  Floats along, radius;
  [[gnu::always_inline]] Untried(const BeadLanes& j, const Floats& foot) {
    const Floats outside = lanes::larger(Floats{}, lanes::abs(foot) - j.half_length);
    along = outside + j.beyond;
    radius = j.max_radius - j.thinning * lanes::larger(Floats{}, lanes::abs(foot) - outside - j.beyond);
  }
  [[gnu::always_inline]] Floats distance2(const BeadLanes& j, const Floats& across2) const {
    return lanes::smaller(across2, lanes::all(j.widest * j.widest)) + along * along;
  }
};

/// Coordinate of the k-th bead of j after `nearest`, or of the last one that there is.
[[gnu::always_inline]] inline Floats bead_offset(const BeadLanes& j, const Floats& nearest, int k) {
  const Floats index =
      lanes::smaller(lanes::larger(nearest + static_cast<float>(k), Floats{}), lanes::all(j.last));
  return index * j.pitch - j.half_length;
}

/// Which of kLanes beads of i may overlap a bead of j.
SHAKEN_VECTOR_CLONES
BeadRange lanes_may_overlap(const Shared& in, const float* offset_i, const float* radius_i, const BeadLanes& j) {
  const Vectors x = to_center(in, lanes::load(offset_i));
  const Floats foot = -(x.x * in.n_j[0] + x.y * in.n_j[1] + x.z * in.n_j[2]);
  const Floats nearest = nearest_bead(j, foot);
  const Floats radius = lanes::load(radius_i) + in.gap_margin;
  const Untried untried(j, foot);
  const Floats cut = lanes::larger(Floats{}, radius + untried.radius);
  Floats clear = untried.distance2(j, lanes::larger(Floats{}, lanes::dot(x, x) - foot * foot)) - cut * cut;
  for (int k = -j.reach; k <= j.reach; ++k) {
    const Floats s_j = bead_offset(j, nearest, k);
    const Vectors r{x.x + s_j * in.n_j[0], x.y + s_j * in.n_j[1], x.z + s_j * in.n_j[2]};
    const Floats touch = lanes::larger(Floats{}, radius + j.mid_radius - j.taper * lanes::abs(s_j));
    clear = lanes::smaller(clear, lanes::dot(r, r) - touch * touch);
  }
  if (lanes::least(clear) > 0.0F) return {};
  constexpr float kNone = 1e3F;
  const Floats index{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const auto near = clear <= 0.0F;
  return {static_cast<int>(lanes::least(near ? index : lanes::all(kNone))),
          static_cast<int>(-lanes::least(near ? -index : lanes::all(kNone))) + 1};
}

/// A time as a fraction, so that the smallest of many is found without dividing.
struct Fraction {
  Floats above, below;  ///< neither negative; forever if `below` is 0
  [[gnu::always_inline]] void take_smaller(const Floats& other_above, const Floats& other_below) {
    const auto other = other_above * below < above * other_below;
    above = other ? other_above : above;
    below = other ? other_below : below;
  }
  [[gnu::always_inline]] float least() const { return lanes::least(above / (below + 1e-30F)); }
};

/// Takes the safe time of beads of i and of j at s_i and s_j, whose centres are r apart, into account: with a gap,
/// gap >= g + g' t - curvature t^2, where t^2 <= horizon t; overlapping, g' >= g'(0) - 2 curvature t.
[[gnu::always_inline]] inline void take_safe_time(Fraction& safe, const Relative& m, const Floats& s_i,
                                                  const Floats& s_j, const Vectors& r, const Floats& inverse_distance,
                                                  const Floats& gap, float horizon) {
  const Floats vx = m.v[0] + s_j * m.turn_j[0] - s_i * m.turn_i[0];
  const Floats vy = m.v[1] + s_j * m.turn_j[1] - s_i * m.turn_i[1];
  const Floats vz = m.v[2] + s_j * m.turn_j[2] - s_i * m.turn_i[2];
  const Floats up = lanes::abs(r.z) * inverse_distance;
  const Floats size_i = lanes::abs(s_i);
  const Floats size_j = lanes::abs(s_j);
  const Floats stray = m.stray + m.stray_z * up + (size_i + size_j) * (m.stray_turning + m.stray_turning_z * up);
  const Floats rate = (vx * r.x + vy * r.y + vz * r.z) * inverse_distance - stray;
  const Floats curvature = size_i * m.bend_i + size_j * m.bend_j;
  const auto apart = gap > 0.0F;
  safe.take_smaller(apart ? gap : lanes::larger(rate, Floats{}),
                    apart ? lanes::larger(curvature * horizon - rate, Floats{}) : 2.0F * curvature + 1e-3F);
}

/// Safe times of kLanes beads of i against the beads of j around each one's foot on j's axis.
SHAKEN_VECTOR_CLONES
SafeTime lanes_safe_time(const Shared& in, const Relative& narrow, const Relative& wide, const float* offset_i,
                         const float* radius_i, const BeadLanes& j, float horizon) {
  const Floats s_i = lanes::load(offset_i);
  const Floats radius = lanes::load(radius_i) + in.gap_margin;
  const Vectors x = to_center(in, s_i);
  const Floats foot = -(x.x * in.n_j[0] + x.y * in.n_j[1] + x.z * in.n_j[2]);
  const Floats nearest = nearest_bead(j, foot);
  const Untried untried(j, foot);
  const Floats across2 = lanes::larger(Floats{}, lanes::dot(x, x) - foot * foot);
  const Floats far =
      lanes::larger(Floats{}, lanes::sqrt(untried.distance2(j, across2)) - radius - untried.radius);
  Fraction safe_narrow{far, lanes::all(narrow.fastest)};
  Fraction safe_wide{far, lanes::all(wide.fastest)};
  for (int k = -j.reach; k <= j.reach; ++k) {
    const Floats s_j = bead_offset(j, nearest, k);
    const Vectors r{x.x + s_j * in.n_j[0], x.y + s_j * in.n_j[1], x.z + s_j * in.n_j[2]};
    const Floats distance = lanes::sqrt(lanes::dot(r, r));
    const Floats inverse = 1.0F / (distance + 1e-20F);
    const Floats gap = distance - (radius + j.mid_radius - j.taper * lanes::abs(s_j));
    take_safe_time(safe_narrow, narrow, s_i, s_j, r, inverse, gap, horizon);
    take_safe_time(safe_wide, wide, s_i, s_j, r, inverse, gap, horizon);
  }
  return {safe_narrow.least(), safe_wide.least()};
}

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
                  const float* turn_j, float half_rate2_i, float half_rate2_j, const Allowance& allow) {
  Relative m;
  for (int c = 0; c < 3; ++c) {
    m.v[c] = v_j[c] - v_i[c];
    m.turn_i[c] = turn_i[c];
    m.turn_j[c] = turn_j[c];
  }
  m.bend_i = half_rate2_i;
  m.bend_j = half_rate2_j;
  m.stray_z = 2.0F * allow.velocity_z;
  m.stray_turning = allow.turning_xy;
  m.stray_turning_z = allow.turning_z;
  // |turning| never exceeds the precession's rate
  const float fastest = norm(m.v) + i.half_length * (std::sqrt(2.0F * half_rate2_i)) +
                        j.half_length * (std::sqrt(2.0F * half_rate2_j)) +
                        2.0F * (allow.velocity_xy + allow.velocity_z) + 1e-3F;
  // floats carry 6e-8; a dozen roundings of speeds
  m.stray = 2.0F * allow.velocity_xy + 1e-6F + 3e-6F * fastest;
  m.fastest = fastest * 1.00001F;
  return m;
}

}  // namespace

BeadLanes::BeadLanes(const Species& species)
    : half_length(static_cast<float>(species.half_length)),
      mid_radius(static_cast<float>(species.mid_radius)),
      max_radius(static_cast<float>(species.max_radius)),
      taper(static_cast<float>(species.taper())),
      last(static_cast<float>(species.n_beads() - 1)),
      pitch(species.n_beads() > 1 ? static_cast<float>(2.0 * species.half_length / (species.n_beads() - 1)) : 1.0F),
      reach(species.n_beads() > 1 ? static_cast<int>(std::ceil(1.1F * max_radius / pitch - 0.5F)) : 0),
      beyond((static_cast<float>(reach) + 0.5F) * pitch) {
  // a thinning of more than this would let `widest` fall to where rods touch
  if (taper > 0.0F && taper < 0.3F) thinning = taper;
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
    const BeadRange some = lanes_may_overlap(in, i.offset.data() + first, i.radius.data() + first, j);
    if (some.empty()) continue;
    if (beads.empty()) beads.from = static_cast<int>(first) + some.from;
    beads.to = static_cast<int>(first) + some.to;
  }
  return beads;
}

SafeTime bead_safe_time(const BeadLanes& i, const Outlook& a, const BeadLanes& j, const Outlook& b, const Vec3& D,
                        const Allowances& allowances, float horizon) {
  const Shared in = shared(i, a.director, j, b.director, D);
  const Relative narrow =
      relative(i, j, a.velocity, b.velocity, a.turning, b.turning, a.half_rate2, b.half_rate2, allowances.narrow);
  const Relative wide = relative(i, j, a.wide_velocity, b.wide_velocity, a.wide_turning, b.wide_turning,
                                 a.wide_half_rate2, b.wide_half_rate2, allowances.wide);
  SafeTime safe{horizon, horizon};
  for (std::size_t first = 0; first < i.offset.size(); first += kLanes) {
    const SafeTime some = lanes_safe_time(in, narrow, wide, i.offset.data() + first, i.radius.data() + first, j, horizon);
    safe.narrow = std::min(safe.narrow, some.narrow);
    safe.wide = std::min(safe.wide, some.wide);
  }
  return {safe.narrow * (1.0F - 1e-5F), safe.wide * (1.0F - 1e-5F)};
}

}  // namespace shaken
