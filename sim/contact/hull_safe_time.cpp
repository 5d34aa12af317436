// SPDX-License-Identifier: MIT
#include "sim/contact/hull_safe_time.h"

#include <algorithm>

#include "sim/core/vector_clones.h"

namespace shaken {
namespace {

using lanes::Floats;
using lanes::Vectors;

/// Point of an axis (|s| <= h, leaning towards its thick middle) from which a point at `foot` along and `across`
/// beside it is nearest, measured from the hull's surface.
[[gnu::always_inline]] inline Floats nearest_on_axis(const Floats& half_length, float lean, const Floats& foot,
                                                     const Floats& across) {
  const Floats far = lanes::larger(Floats{}, lanes::abs(foot) - lean * across);
  return lanes::clamp(lanes::with_sign_of(far, foot), half_length);
}

/// How much a director's component along a pair's direction can grow: |n . d| <= |c + w t| + (q t + b) t.
struct Cosine {
  Floats c, w, q, b;
  [[gnu::always_inline]] Floats at(const Floats& t) const { return lanes::abs(c + w * t) + (q * t + b) * t; }
};

/// Time for which gap + rate t - width_i(t) - width_j(t) stays positive.
[[gnu::always_inline]] inline Floats safe_time(const Hull& i, const Hull& j, const Floats& gap, const Floats& rate,
                                               const Cosine& cosine_i, const Cosine& cosine_j, float horizon) {
  const auto gap_at = [&](const Floats& t) __attribute__((always_inline)) {
    return gap + rate * t - i.half_length * lanes::larger(Floats{}, cosine_i.at(t) - i.taper) -
           j.half_length * lanes::larger(Floats{}, cosine_j.at(t) - j.taper);
  };
  Floats safe{};
  Floats beyond = lanes::all(horizon);
  Floats gap_safe = gap_at(safe);
  Floats gap_beyond = gap_at(beyond);
  const Floats at_start = gap_safe;
  const Floats at_end = gap_beyond;
  for (int step = 0; step < 3; ++step) {
    const Floats t = safe + (beyond - safe) * (gap_safe / (gap_safe - gap_beyond + 1e-30F));
    const Floats gap_t = gap_at(t);
    const auto inside = gap_t >= 0.0F;  // not so only by rounding: the chord of a concave function lies below it
    safe = inside ? t : safe;
    gap_safe = inside ? gap_t : gap_safe;
    beyond = inside ? beyond : t;
    gap_beyond = inside ? gap_beyond : gap_t;
  }
  safe = at_end >= 0.0F ? lanes::all(horizon) : safe;
  return at_start > 0.0F ? safe : Floats{};
}

}  // namespace

void PairLanes::set(int lane, const Vec3& D_ij, const Outlook& i, const Outlook& j) {
  for (int c = 0; c < 3; ++c) {
    D[c][lane] = static_cast<float>(D_ij[c]);
    director_i[c][lane] = i.director[c];
    director_j[c][lane] = j.director[c];
    turning_i[c][lane] = i.turning[c];
    turning_j[c][lane] = j.turning[c];
    velocity[c][lane] = j.velocity[c] - i.velocity[c];
    wide_turning_i[c][lane] = i.wide_turning[c];
    wide_turning_j[c][lane] = j.wide_turning[c];
    wide_velocity[c][lane] = j.wide_velocity[c] - i.wide_velocity[c];
  }
  half_rate2_i[lane] = i.half_rate2;
  half_rate2_j[lane] = j.half_rate2;
  wide_half_rate2_i[lane] = i.wide_half_rate2;
  wide_half_rate2_j[lane] = j.wide_half_rate2;
}

SHAKEN_VECTOR_CLONES
void hull_safe_times(const Hull& i, const Hull& j, const PairLanes& pairs, const Allowances& allowances, float horizon,
                     HullSafeTimes& safe) {
  // floats carry 6e-8; a dozen roundings of lengths and of speeds
  constexpr float kLengthRounding = 1.5e-6F;
  constexpr float kRateRounding = 3e-6F;
  const auto lean = [](const Hull& hull) { return hull.taper / std::sqrt(std::max(1e-12F, 1.0F - hull.taper * hull.taper)); };
  const float lean_i = lean(i);
  const float lean_j = lean(j);
  const Floats h_i = lanes::all(i.half_length);
  const Floats h_j = lanes::all(j.half_length);
  const Vectors D = lanes::load(pairs.D);
  const Vectors n_i = lanes::load(pairs.director_i);
  const Vectors n_j = lanes::load(pairs.director_j);

  // closest points s on i and t on j; distances between them from products of the inputs
  const Floats c = lanes::dot(n_i, n_j);
  const Floats d_i = lanes::dot(D, n_i);
  const Floats d_j = lanes::dot(D, n_j);
  const Floats D2 = lanes::dot(D, D);
  const Floats det = 1.0F - c * c;
  Floats s = lanes::clamp(det > 1e-5F ? (d_i - c * d_j) / det : 0.5F * d_i, h_i);
  Floats t{};
  for (int pass = 0; pass < 2; ++pass) {
    const Floats foot_j = c * s - d_j;
    const Floats across_j = D2 + s * (s - 2.0F * d_i) - foot_j * foot_j;
    t = nearest_on_axis(h_j, lean_j, foot_j, lanes::sqrt(lanes::larger(Floats{}, across_j)));
    const Floats foot_i = d_i + c * t;
    const Floats across_i = D2 + t * (t + 2.0F * d_j) - foot_i * foot_i;
    s = nearest_on_axis(h_i, lean_i, foot_i, lanes::sqrt(lanes::larger(Floats{}, across_i)));
  }
  Vectors d{D.x + t * n_j.x - s * n_i.x, D.y + t * n_j.y - s * n_i.y, D.z + t * n_j.z - s * n_i.z};
  const Floats distance2 = lanes::dot(d, d);
  const auto apart = distance2 > 1e-12F;
  const Floats scale = 1.0F / lanes::sqrt(apart ? distance2 : lanes::all(1.0F));
  d.x = apart ? d.x * scale : Floats{};
  d.y = apart ? d.y * scale : Floats{};
  d.z = apart ? d.z * scale : lanes::all(1.0F);
  lanes::store(safe.direction[0], d.x);
  lanes::store(safe.direction[1], d.y);
  lanes::store(safe.direction[2], d.z);

  const Floats gap = lanes::dot(D, d) - (i.mid_radius + j.mid_radius + 1e-6F) -
                     kLengthRounding * (lanes::sqrt(D2) + (i.half_length + j.half_length));
  const Floats c_i = lanes::dot(n_i, d);
  const Floats c_j = lanes::dot(n_j, d);

  const Floats up = lanes::abs(d.z);
  const auto bound = [&](const Vectors& v, const Vectors& turn_i, const Vectors& turn_j, const Floats& q_i,
                         const Floats& q_j, const Allowance& allow) __attribute__((always_inline)) {
    const Floats stray = 2.0F * (allow.velocity_xy + up * allow.velocity_z);
    const Floats stray_turning = allow.turning_xy + up * allow.turning_z;
    return safe_time(i, j, gap, lanes::dot(v, d) - stray - (1e-4F + kRateRounding * lanes::size1(v)),
                     {c_i, lanes::dot(turn_i, d), q_i, stray_turning + kRateRounding * lanes::size1(turn_i)},
                     {c_j, lanes::dot(turn_j, d), q_j, stray_turning + kRateRounding * lanes::size1(turn_j)}, horizon);
  };
  lanes::store(safe.narrow,
               bound(lanes::load(pairs.velocity), lanes::load(pairs.turning_i), lanes::load(pairs.turning_j),
                     lanes::load(pairs.half_rate2_i), lanes::load(pairs.half_rate2_j), allowances.narrow));
  lanes::store(safe.wide, bound(lanes::load(pairs.wide_velocity), lanes::load(pairs.wide_turning_i),
                                lanes::load(pairs.wide_turning_j), lanes::load(pairs.wide_half_rate2_i),
                                lanes::load(pairs.wide_half_rate2_j), allowances.wide));
}

}  // namespace shaken
