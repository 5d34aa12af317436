// SPDX-License-Identifier: MIT
#include "sim/contact/hull_safe_time.h"

#include "sim/core/vector_clones.h"

namespace shaken {
namespace {

inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float clamp(float x, float limit) { return larger(-limit, smaller(limit, x)); }

/// Point of an axis (|s| <= h, thinning by `taper`) from which a point at `foot` along and `across` beside it is
/// nearest, measured from the hull's surface: the foot, moved towards the thick middle.
inline float nearest_on_axis(float half_length, float lean, float foot, float across) {
  const float far = larger(0.0F, std::fabs(foot) - lean * across);
  return clamp(std::copysign(far, foot), half_length);
}

/// How much a pair's gap along its direction can have shrunk.
struct GapBound {
  float gap;            ///< at the start, without the widths that the directors give [mm]
  float rate;           ///< [mm/s]
  float c_i, c_j;       ///< cosines n . d
  float w_i, w_j;       ///< their rates [1/s]
  float b_i, b_j;       ///< what the rates may stray by [1/s]
  float q_i, q_j;       ///< half of the bounds on the second derivatives [1/s^2]
  float h_i, h_j;       ///< half-lengths
  float k_i, k_j;       ///< tapers

  float at(float t) const {
    const float tilt_i = std::fabs(c_i + w_i * t) + (q_i * t + b_i) * t;
    const float tilt_j = std::fabs(c_j + w_j * t) + (q_j * t + b_j) * t;
    return gap + rate * t - h_i * larger(0.0F, tilt_i - k_i) - h_j * larger(0.0F, tilt_j - k_j);
  }

  float safe_time(float horizon) const {
    float safe = 0;
    float beyond = horizon;
    float gap_safe = at(0.0F);
    float gap_beyond = at(horizon);
    const bool open = gap_safe > 0;
    const bool all = gap_beyond >= 0;
    for (int step = 0; step < 3; ++step) {
      const float t = safe + (beyond - safe) * (gap_safe / (gap_safe - gap_beyond + 1e-30F));
      const float gap_t = at(t);
      const bool inside = gap_t >= 0;  // not so only by rounding: the chord of a concave function lies below it
      safe = inside ? t : safe;
      gap_safe = inside ? gap_t : gap_safe;
      beyond = inside ? beyond : t;
      gap_beyond = inside ? gap_beyond : gap_t;
    }
    return open ? (all ? horizon : safe) : 0.0F;
  }
};

inline float dot(const float (*a)[kLanes], const float (*b)[kLanes], int l) {
  return a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l];
}
inline float sum_of_sizes(const float (*a)[kLanes], int l) {
  return std::fabs(a[0][l]) + std::fabs(a[1][l]) + std::fabs(a[2][l]);
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
    turning_center_i[c][lane] = i.turning_center[c];
    turning_center_j[c][lane] = j.turning_center[c];
    velocity_center[c][lane] = j.velocity_center[c] - i.velocity_center[c];
  }
  half_rate2_i[lane] = i.half_rate2;
  half_rate2_j[lane] = j.half_rate2;
  half_rate2_limit_i[lane] = i.half_rate2_limit;
  half_rate2_limit_j[lane] = j.half_rate2_limit;
}

SHAKEN_VECTOR_CLONES
void hull_safe_times(const Hull& hull_i, const Hull& hull_j, const PairLanes& in, const Allowance& allowance,
                     float horizon, HullSafeTimes& out) {
  // floats carry 6e-8; a dozen roundings of lengths and of speeds
  constexpr float kLengthRounding = 1.5e-6F;
  constexpr float kRateRounding = 3e-6F;
  const float h_i = hull_i.half_length;
  const float h_j = hull_j.half_length;
  const float k_i = hull_i.taper;
  const float k_j = hull_j.taper;
  const float lean_i = k_i / std::sqrt(larger(1e-12F, 1.0F - k_i * k_i));
  const float lean_j = k_j / std::sqrt(larger(1e-12F, 1.0F - k_j * k_j));
  const float radii = hull_i.mid_radius + hull_j.mid_radius + 1e-6F + kLengthRounding * (h_i + h_j);
  const Allowance allow = allowance;

  for (int l = 0; l < kLanes; ++l) {
    // closest points s on i and t on j, distances between them from products of the inputs
    const float c = dot(in.director_i, in.director_j, l);
    const float d_i = dot(in.D, in.director_i, l);
    const float d_j = dot(in.D, in.director_j, l);
    const float D2 = dot(in.D, in.D, l);
    const float det = 1.0F - c * c;
    const bool crossing = det > 1e-5F;
    float s = clamp(crossing ? (d_i - c * d_j) / (crossing ? det : 1.0F) : 0.5F * d_i, h_i);
    float t = 0;
    for (int pass = 0; pass < 2; ++pass) {
      const float foot_j = c * s - d_j;
      const float across_j = std::sqrt(larger(0.0F, D2 + s * s - 2.0F * s * d_i - foot_j * foot_j));
      t = nearest_on_axis(h_j, lean_j, foot_j, across_j);
      const float foot_i = d_i + c * t;
      const float across_i = std::sqrt(larger(0.0F, D2 + t * t + 2.0F * t * d_j - foot_i * foot_i));
      s = nearest_on_axis(h_i, lean_i, foot_i, across_i);
    }
    float x = in.D[0][l] + t * in.director_j[0][l] - s * in.director_i[0][l];
    float y = in.D[1][l] + t * in.director_j[1][l] - s * in.director_i[1][l];
    float z = in.D[2][l] + t * in.director_j[2][l] - s * in.director_i[2][l];
    const float distance2 = x * x + y * y + z * z;
    const bool apart = distance2 > 1e-12F;
    const float scale = 1.0F / std::sqrt(apart ? distance2 : 1.0F);
    x = apart ? x * scale : 0.0F;
    y = apart ? y * scale : 0.0F;
    z = apart ? z * scale : 1.0F;
    out.direction[0][l] = x;
    out.direction[1][l] = y;
    out.direction[2][l] = z;

    const auto along = [&](const float(*a)[kLanes]) { return a[0][l] * x + a[1][l] * y + a[2][l] * z; };
    const float up = std::fabs(z);
    const float turn_rounding =
        kRateRounding * (sum_of_sizes(in.turning_i, l) + sum_of_sizes(in.turning_j, l) +
                         sum_of_sizes(in.turning_center_i, l) + sum_of_sizes(in.turning_center_j, l));
    const float rate_rounding =
        1e-4F + kRateRounding * (sum_of_sizes(in.velocity, l) + sum_of_sizes(in.velocity_center, l));
    GapBound bound;
    bound.gap = along(in.D) - radii - kLengthRounding * std::sqrt(D2);
    bound.rate = along(in.velocity) - rate_rounding;
    bound.c_i = along(in.director_i);
    bound.c_j = along(in.director_j);
    bound.w_i = along(in.turning_i);
    bound.w_j = along(in.turning_j);
    bound.b_i = turn_rounding;
    bound.b_j = turn_rounding;
    bound.q_i = in.half_rate2_i[l] * (1.0F + kRateRounding);
    bound.q_j = in.half_rate2_j[l] * (1.0F + kRateRounding);
    bound.h_i = h_i;
    bound.h_j = h_j;
    bound.k_i = k_i;
    bound.k_j = k_j;
    out.steady[l] = bound.safe_time(horizon);

    const float turn_stray = allow.turning_xy + up * allow.turning_z + turn_rounding;
    bound.rate = along(in.velocity_center) - rate_rounding - 2.0F * (allow.velocity_xy + up * allow.velocity_z);
    bound.w_i = along(in.turning_center_i);
    bound.w_j = along(in.turning_center_j);
    bound.b_i = turn_stray;
    bound.b_j = turn_stray;
    bound.q_i = in.half_rate2_limit_i[l] * (1.0F + kRateRounding);
    bound.q_j = in.half_rate2_limit_j[l] * (1.0F + kRateRounding);
    out.straying[l] = bound.safe_time(horizon);
  }
}

}  // namespace shaken
