// SPDX-License-Identifier: MIT
#include "sim/contact/safe_time.h"

#include <algorithm>
#include <cmath>

namespace shaken {
namespace {

/// Point of an axis (|s| <= h, thinning by `taper`) from which a point at `foot` along and `across` beside it is
/// nearest, measured from the hull's surface: the foot, moved towards the thick middle.
double nearest_on_axis(const Hull& hull, double foot, double across) {
  const double shift = hull.taper * across / std::sqrt(std::max(1e-12, 1.0 - hull.taper * hull.taper));
  double s = foot;
  if (shift >= 0) {
    s = foot > shift ? foot - shift : (foot < -shift ? foot + shift : 0.0);
  } else {  // thicker at the ends
    s = foot >= 0 ? foot - shift : foot + shift;
  }
  return std::clamp(s, -hull.half_length, hull.half_length);
}

/// First time at which gap + rate t - curvature t^2 can reach zero (all from above), for gap > 0.
double quadratic_safe_time(double gap, double rate, double curvature) {
  const double root = std::sqrt(rate * rate + 4.0 * curvature * gap);
  const double denominator = root - rate;
  return denominator > 0 ? 2.0 * gap / denominator : kForever;
}

}  // namespace

Vec3 separating_direction(const Hull& i, const Vec3& n_i, const Hull& j, const Vec3& n_j, const Vec3& D) {
  const double c = n_i.dot(n_j);
  const double d_i = D.dot(n_i);
  const double d_j = D.dot(n_j);
  const double det = 1.0 - c * c;
  double s = det > 1e-9 ? std::clamp((d_i - c * d_j) / det, -i.half_length, i.half_length)
                        : std::clamp(0.5 * d_i, -i.half_length, i.half_length);
  double t = 0;
  Vec3 r;
  for (int pass = 0; pass < 2; ++pass) {
    const double foot_j = c * s - d_j;
    r = D + foot_j * n_j - s * n_i;
    t = nearest_on_axis(j, foot_j, r.norm());
    const double foot_i = d_i + c * t;
    r = D + t * n_j - foot_i * n_i;
    s = nearest_on_axis(i, foot_i, r.norm());
  }
  r = D + t * n_j - s * n_i;
  const double distance = r.norm();
  return distance > 1e-9 ? Vec3(r / distance) : Vec3(Vec3::UnitZ());
}

double hull_gap(const Hull& i, double c_i, const Hull& j, double c_j, double separation) {
  return separation - i.mid_radius - j.mid_radius - i.half_length * std::max(0.0, std::abs(c_i) - i.taper) -
         j.half_length * std::max(0.0, std::abs(c_j) - j.taper);
}

double hull_safe_time(const Hull& i, const AxisCosine& axis_i, const Hull& j, const AxisCosine& axis_j,
                      double separation, double rate, const Allowance& allowance, double horizon) {
  const auto largest_cosine = [&](const AxisCosine& axis, double t) {
    const double s = axis.age + t;
    return std::abs(axis.c + axis.rate * s) + (axis.half_rate2 * s + allowance.precession) * s;
  };
  const double closing = rate - 2.0 * allowance.velocity;
  const auto gap_at = [&](double t) {
    return hull_gap(i, largest_cosine(axis_i, t), j, largest_cosine(axis_j, t), separation + closing * t) - kGapMargin;
  };

  double safe = 0;
  double gap_safe = gap_at(0);
  if (gap_safe <= 0) return 0;
  double beyond = horizon;
  double gap_beyond = gap_at(beyond);
  if (gap_beyond >= 0) return horizon;
  for (int step = 0; step < 3; ++step) {
    const double t = safe + (beyond - safe) * (gap_safe / (gap_safe - gap_beyond));
    const double gap = gap_at(t);
    if (gap < 0) {  // only by rounding: the chord of a concave function lies below it
      beyond = t;
      gap_beyond = gap;
      continue;
    }
    safe = t;
    gap_safe = gap;
  }
  return safe;
}

double bead_safe_time(const Species& i, const FlightState& state_i, const Species& j, const FlightState& state_j,
                      const Vec3& D, const Allowance& allowance, double horizon) {
  const Vec3 v = state_j.velocity - state_i.velocity;
  const double stray = 2.0 * allowance.velocity + (i.half_length + j.half_length) * allowance.precession;
  // no two beads approach faster than this within the horizon
  const double fastest =
      v.norm() + i.half_length * std::sqrt(state_i.rate2) + j.half_length * std::sqrt(state_j.rate2) + stray;
  // second derivative of the directors, also after the precession has strayed by its allowance
  const double strayed_i = std::sqrt(state_i.rate2) + allowance.precession;
  const double strayed_j = std::sqrt(state_j.rate2) + allowance.precession;
  const double bend_i = strayed_i * strayed_i;
  const double bend_j = strayed_j * strayed_j;
  double safe = horizon;

  const int last = j.n_beads() - 1;
  const double pitch = last > 0 ? 2.0 * j.half_length / last : 1.0;
  for (int a = 0; a < i.n_beads(); ++a) {
    const Vec3 from_a = D - i.bead_offset[a] * state_i.director;
    const double foot = -from_a.dot(state_j.director);
    const double across2 = std::max(0.0, from_a.squaredNorm() - foot * foot);
    const double reach = i.bead_radius[a] + j.max_radius + kGapMargin + fastest * safe;
    if (across2 > reach * reach) continue;
    const double half_chord = std::sqrt(reach * reach - across2);
    const int from = std::max(0, static_cast<int>(std::ceil((foot - half_chord + j.half_length) / pitch - 1e-9)));
    const int to = std::min(last, static_cast<int>(std::floor((foot + half_chord + j.half_length) / pitch + 1e-9)));
    for (int b = from; b <= to; ++b) {
      const Vec3 r = from_a + j.bead_offset[b] * state_j.director;
      const double touch = i.bead_radius[a] + j.bead_radius[b] + kGapMargin;
      const double r2 = r.squaredNorm();
      const double far = touch + fastest * safe;
      if (r2 > far * far) continue;
      const double distance = std::sqrt(r2);
      if (distance < 1e-9) return 0;
      const Vec3 r_rate = v + j.bead_offset[b] * state_j.turning - i.bead_offset[a] * state_i.turning;
      const double rate = r_rate.dot(r) / distance - stray - kRateMargin;
      const double curvature = 0.5 * (std::abs(i.bead_offset[a]) * bend_i + std::abs(j.bead_offset[b]) * bend_j);
      const double gap = distance - touch;
      if (gap > 0) {
        safe = std::min(safe, quadratic_safe_time(gap, rate, curvature));
      } else if (rate > 0) {
        // they overlap and recede: nothing happens until they approach, and d^2 distance / dt^2 >= -2 curvature
        if (curvature > 0) safe = std::min(safe, 0.5 * rate / curvature);
      } else {
        return 0;
      }
    }
  }
  return safe;
}

}  // namespace shaken
