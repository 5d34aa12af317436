// SPDX-License-Identifier: MIT
#include "sim/contact/bead_safe_time.h"

#include <algorithm>

#include "sim/core/vector_clones.h"

namespace shaken {
namespace {

/// What the lanes share: everything relative to the centre of rod i, as floats.
struct Shared {
  float D[3], n_i[3], n_j[3];
  float gap_margin;
};

/// One of the two motions that a bound is made for: steady, or straying within the allowance.
struct Relative {
  float v[3], turn_i[3], turn_j[3];
  float bend_i, bend_j;              ///< halves of the bounds on the directors' second derivatives
  float stray, stray_z;              ///< what the centres' relative velocity may stray by, across and along z
  float stray_turning, stray_turning_z;  ///< the same for each director's rate
  float fastest;                     ///< no two beads approach faster than this
};

inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }

/// Bead of j nearest to the bead at (x, y, z) from j's centre, as an index.
inline float nearest_bead(const BeadLanes& j, float foot) {
  const float inside = smaller(larger((foot + j.half_length) / j.pitch, 0.0F), j.last);
  return static_cast<float>(static_cast<int>(inside + 0.5F));
}

SHAKEN_VECTOR_CLONES
bool lanes_may_overlap(const Shared& in, const float* offset_i, const float* radius_i, const BeadLanes& j) {
  float deepest[kLanes];
  const float beyond = (static_cast<float>(j.reach) + 0.5F) * j.pitch;
  for (int a = 0; a < kLanes; ++a) {
    const float x = in.D[0] - offset_i[a] * in.n_i[0];
    const float y = in.D[1] - offset_i[a] * in.n_i[1];
    const float z = in.D[2] - offset_i[a] * in.n_i[2];
    const float foot = -(x * in.n_j[0] + y * in.n_j[1] + z * in.n_j[2]);
    const float nearest = nearest_bead(j, foot);
    // beads of j that are not tried below: at least this far along its axis
    const float cut = larger(0.0F, radius_i[a] + j.max_radius + in.gap_margin);
    float depth = cut * cut - (larger(0.0F, x * x + y * y + z * z - foot * foot) + beyond * beyond);
    for (int k = -j.reach; k <= j.reach; ++k) {
      const float index = smaller(larger(nearest + static_cast<float>(k), 0.0F), j.last);
      const float s_j = index * j.pitch - j.half_length;
      const float rx = x + s_j * in.n_j[0];
      const float ry = y + s_j * in.n_j[1];
      const float rz = z + s_j * in.n_j[2];
      const float touch = larger(0.0F, radius_i[a] + j.mid_radius - j.taper * std::fabs(s_j) + in.gap_margin);
      depth = larger(depth, touch * touch - (rx * rx + ry * ry + rz * rz));
    }
    deepest[a] = depth;
  }
  float depth = -1e30F;
  for (int a = 0; a < kLanes; ++a) depth = larger(depth, deepest[a]);
  return depth >= 0.0F;
}

/// Safe time of two beads: gap, its rate now, and the largest curvature of gap >= g + g' t - curvature t^2.
inline float safe_time(float gap, float rate, float curvature) {
  const float open = larger(gap, 0.0F);
  const float root = std::sqrt(rate * rate + 4.0F * curvature * open);
  // receding: the later root if they are apart, the turning point if they overlap; approaching: the first root
  const float recede = gap > 0.0F ? rate + root : rate;
  const float above = rate > 0.0F ? recede : 2.0F * open;
  const float below = (rate > 0.0F ? 2.0F * curvature : root - rate) + 1e-30F;
  return above / below;
}

/// Safe times of kLanes beads of i against the beads of j around each one's foot on j's axis.
SHAKEN_VECTOR_CLONES
void lanes_safe_time(const Shared& in, const Relative& steady, const Relative& straying, const float* offset_i,
                     const float* radius_i, const BeadLanes& j, float* safe_steady, float* safe_straying) {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes], nearest[kLanes];
  const float beyond = (static_cast<float>(j.reach) + 0.5F) * j.pitch;
  for (int a = 0; a < kLanes; ++a) {
    x[a] = in.D[0] - offset_i[a] * in.n_i[0];
    y[a] = in.D[1] - offset_i[a] * in.n_i[1];
    z[a] = in.D[2] - offset_i[a] * in.n_i[2];
    const float foot = -(x[a] * in.n_j[0] + y[a] * in.n_j[1] + z[a] * in.n_j[2]);
    nearest[a] = nearest_bead(j, foot);
    // beads of j that are not tried below are at least this far along its axis
    const float across2 = x[a] * x[a] + y[a] * y[a] + z[a] * z[a] - foot * foot;
    const float far = larger(
        0.0F, std::sqrt(larger(across2, 0.0F) + beyond * beyond) - radius_i[a] - j.max_radius - in.gap_margin);
    safe_steady[a] = far / steady.fastest;
    safe_straying[a] = far / straying.fastest;
  }
  for (int k = -j.reach; k <= j.reach; ++k) {
    for (int a = 0; a < kLanes; ++a) {
      const float index = smaller(larger(nearest[a] + static_cast<float>(k), 0.0F), j.last);
      const float s_j = index * j.pitch - j.half_length;
      const float s_i = offset_i[a];
      const float abs_s_j = std::fabs(s_j);
      const float abs_s_i = std::fabs(s_i);
      const float rx = x[a] + s_j * in.n_j[0];
      const float ry = y[a] + s_j * in.n_j[1];
      const float rz = z[a] + s_j * in.n_j[2];
      const float distance = std::sqrt(rx * rx + ry * ry + rz * rz);
      const float inverse = 1.0F / (distance + 1e-20F);
      const float gap = distance - (radius_i[a] + j.mid_radius - j.taper * abs_s_j + in.gap_margin);
      const float up = std::fabs(rz) * inverse;
      const auto bound = [&](const Relative& m) {
        const float vx = m.v[0] + s_j * m.turn_j[0] - s_i * m.turn_i[0];
        const float vy = m.v[1] + s_j * m.turn_j[1] - s_i * m.turn_i[1];
        const float vz = m.v[2] + s_j * m.turn_j[2] - s_i * m.turn_i[2];
        const float stray =
            m.stray + m.stray_z * up + (abs_s_i + abs_s_j) * (m.stray_turning + m.stray_turning_z * up);
        const float rate = (vx * rx + vy * ry + vz * rz) * inverse - stray;
        return safe_time(gap, rate, abs_s_i * m.bend_i + abs_s_j * m.bend_j);
      };
      safe_steady[a] = smaller(safe_steady[a], bound(steady));
      safe_straying[a] = smaller(safe_straying[a], bound(straying));
    }
  }
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

/// `allow` is zero for steady motion.
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
      reach(species.n_beads() > 1 ? static_cast<int>(std::ceil(1.7F * max_radius / pitch - 0.5F)) : 0) {
  const int n_lanes = (species.n_beads() + kLanes - 1) / kLanes * kLanes;
  for (int lane = 0; lane < n_lanes; ++lane) {
    const bool is_bead = lane < species.n_beads();
    offset.push_back(is_bead ? static_cast<float>(species.bead_offset[lane]) : 0.0F);
    radius.push_back(is_bead ? static_cast<float>(species.bead_radius[lane]) : -1e3F);  // never near anything
  }
}

bool beads_may_overlap(const BeadLanes& i, const Vec3& n_i, const BeadLanes& j, const Vec3& n_j, const Vec3& D) {
  float director_i[3], director_j[3];
  set_vector(director_i, n_i);
  set_vector(director_j, n_j);
  const Shared in = shared(i, director_i, j, director_j, D);
  for (std::size_t first = 0; first < i.offset.size(); first += kLanes) {
    if (lanes_may_overlap(in, i.offset.data() + first, i.radius.data() + first, j)) return true;
  }
  return false;
}

SafeTime bead_safe_time(const BeadLanes& i, const Outlook& a, const BeadLanes& j, const Outlook& b, const Vec3& D,
                        const Allowance& allowance, float horizon) {
  const Shared in = shared(i, a.director, j, b.director, D);
  const Relative steady =
      relative(i, j, a.velocity, b.velocity, a.turning, b.turning, a.half_rate2, b.half_rate2, Allowance{});
  const Relative straying = relative(i, j, a.velocity_center, b.velocity_center, a.turning_center, b.turning_center,
                                     a.half_rate2_limit, b.half_rate2_limit, allowance);
  SafeTime safe{horizon, horizon};
  alignas(64) float lane_steady[kLanes], lane_straying[kLanes];
  for (std::size_t first = 0; first < i.offset.size(); first += kLanes) {
    lanes_safe_time(in, steady, straying, i.offset.data() + first, i.radius.data() + first, j, lane_steady,
                    lane_straying);
    for (int lane = 0; lane < kLanes; ++lane) {
      safe.steady = smaller(safe.steady, lane_steady[lane]);
      safe.straying = smaller(safe.straying, lane_straying[lane]);
    }
  }
  return {safe.steady * (1.0F - 1e-5F), safe.straying * (1.0F - 1e-5F)};
}

}  // namespace shaken
