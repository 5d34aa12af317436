// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/contact/safe_time.h"
#include "sim/rod/species.h"

/// Slow twins of the bounds on the time to contact: in doubles, one pair at a time, nothing left out.
namespace shaken::test {

/// What an MotionBound says of one of the two kinds of flight.
struct Limits {
  Vec3 velocity, turning;
  double half_rate2;
};
inline Limits limits(const MotionBound& o, bool perturbed) {
  const float* v = perturbed ? o.velocity_centre : o.velocity;
  const float* w = perturbed ? o.turning_centre : o.turning;
  return {Vec3(v[0], v[1], v[2]), Vec3(w[0], w[1], w[2]), perturbed ? o.limit_half_rate2 : o.half_rate2};
}
inline Vec3 director(const MotionBound& o) { return {o.director[0], o.director[1], o.director[2]}; }

/// What the hulls' gap along d can have shrunk to after time t [mm].
inline double least_hull_gap(const Species& s, const MotionBound& i, const MotionBound& j, const Vec3& D, const Vec3& d,
                             const MotionTolerance& allow, bool perturbed, double t) {
  const Limits a = limits(i, perturbed);
  const Limits b = limits(j, perturbed);
  const double up = std::abs(d.z());
  const auto width = [&](const MotionBound& o, const Limits& l) {
    const double cosine = std::abs(director(o).dot(d) + l.turning.dot(d) * t) + l.half_rate2 * t * t +
                          (allow.turning_xy + up * allow.turning_z) * t;
    return s.mid_radius + s.half_length * std::max(0.0, cosine - s.taper());
  };
  return D.dot(d) + ((b.velocity - a.velocity).dot(d) - 2 * (allow.velocity_xy + up * allow.velocity_z)) * t -
         width(i, a) - width(j, b);
}

/// Time at which it reaches zero, by bisection; at most `horizon` [s].
inline double hull_safe_time_twin(const Species& s, const MotionBound& i, const MotionBound& j, const Vec3& D,
                                  const Vec3& d, const MotionTolerance& allow, bool perturbed, double horizon) {
  const auto gap = [&](double t) { return least_hull_gap(s, i, j, D, d, allow, perturbed, t); };
  if (gap(0) <= 0) return 0;
  if (gap(horizon) >= 0) return horizon;
  double low = 0, high = horizon;
  for (int step = 0; step < 60; ++step) (gap(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return low;
}

/// Every bead against every bead [s].
inline double bead_safe_time_twin(const Species& s, const MotionBound& i, const MotionBound& j, const Vec3& D,
                                  const MotionTolerance& allow, bool perturbed, double horizon) {
  const Limits a = limits(i, perturbed);
  const Limits b = limits(j, perturbed);
  double safe = horizon;
  for (int m = 0; m < s.n_beads(); ++m) {
    for (int n = 0; n < s.n_beads(); ++n) {
      const double s_i = s.bead_offset[m];
      const double s_j = s.bead_offset[n];
      const Vec3 r = D + s_j * director(j) - s_i * director(i);
      const Vec3 r_rate = b.velocity - a.velocity + s_j * b.turning - s_i * a.turning;
      const double up = std::abs(r.z()) / r.norm();
      const double drift = 2 * (allow.velocity_xy + up * allow.velocity_z) +
                           (std::abs(s_i) + std::abs(s_j)) * (allow.turning_xy + up * allow.turning_z);
      const double gap = r.norm() - s.bead_radius[m] - s.bead_radius[n];
      const double rate = r_rate.dot(r) / r.norm() - drift;
      const double curvature = std::abs(s_i) * a.half_rate2 + std::abs(s_j) * b.half_rate2;
      if (gap > 0) {
        const double root = std::sqrt(rate * rate + 4 * curvature * gap);
        if (rate > 0 && curvature > 0) {
          safe = std::min(safe, (rate + root) / (2 * curvature));
        } else if (rate <= 0) {
          safe = std::min(safe, 2 * gap / (root - rate));
        }
      } else {
        safe = std::min(safe, rate > 0 ? (curvature > 0 ? rate / (2 * curvature) : horizon) : 0.0);
      }
    }
  }
  return safe;
}

}  // namespace shaken::test
