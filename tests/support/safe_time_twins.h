#pragma once

#include <algorithm>
#include <cmath>

#include "sim/bounds/safe_time.h"
#include "sim/rod/species.h"

/// Slow twins of the bounds on the time to contact: in doubles, one pair at a time, nothing left out.
namespace shaken::test {

inline Vec3 velocity(const FlightBound& o) { return {o.velocity[0], o.velocity[1], o.velocity[2]}; }
inline Vec3 turning(const FlightBound& o) { return {o.turning[0], o.turning[1], o.turning[2]}; }
inline Vec3 director(const FlightBound& o) { return {o.director[0], o.director[1], o.director[2]}; }

/// What the hulls' gap along d can have shrunk to after time t [mm].
inline double least_hull_gap(const Species& s, const FlightBound& i, const FlightBound& j, const Vec3& D, const Vec3& d,
                             double t) {
  const auto width = [&](const FlightBound& o) {
    const double cosine =
        std::abs(director(o).dot(d) + turning(o).dot(d) * t) + static_cast<double>(o.half_rate2) * t * t;
    return s.mid_radius + s.half_length * std::max(0.0, cosine - s.taper());
  };
  return D.dot(d) + (velocity(j) - velocity(i)).dot(d) * t - width(i) - width(j);
}

/// Time at which it reaches zero, by bisection; at most `horizon` [s].
inline double hull_safe_time_twin(const Species& s, const FlightBound& i, const FlightBound& j, const Vec3& D,
                                  const Vec3& d, double horizon) {
  const auto gap = [&](double t) { return least_hull_gap(s, i, j, D, d, t); };
  if (gap(0) <= 0) return 0;
  if (gap(horizon) >= 0) return horizon;
  double low = 0, high = horizon;
  for (int step = 0; step < 60; ++step) (gap(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return low;
}

/// Every bead against every bead [s].
inline double bead_safe_time_twin(const Species& s, const FlightBound& i, const FlightBound& j, const Vec3& D,
                                  double horizon) {
  double safe = horizon;
  for (int m = 0; m < s.n_beads(); ++m) {
    for (int n = 0; n < s.n_beads(); ++n) {
      const double s_i = s.bead_offset[m];
      const double s_j = s.bead_offset[n];
      const Vec3 r = D + s_j * director(j) - s_i * director(i);
      const Vec3 r_rate = velocity(j) - velocity(i) + s_j * turning(j) - s_i * turning(i);
      const double gap = r.norm() - s.bead_radius[m] - s.bead_radius[n];
      const double rate = r_rate.dot(r) / r.norm();
      const double curvature =
          std::abs(s_i) * static_cast<double>(i.half_rate2) + std::abs(s_j) * static_cast<double>(j.half_rate2);
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
