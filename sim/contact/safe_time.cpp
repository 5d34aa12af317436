// SPDX-License-Identifier: MIT
#include "sim/contact/safe_time.h"

#include <algorithm>
#include <cmath>

#include "sim/core/vector_clones.h"

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

namespace {

/// What the lanes of bead_safe_time share: everything relative to the centre of rod i, as floats.
struct LaneInput {
  float D[3], n_i[3], n_j[3], v[3], turn_i[3], turn_j[3];
  float bend_i, bend_j;  // halves of the bounds on the directors' second derivatives
  float stray, gap_margin, fastest;
};

/// Safe time of kLanes beads of i against the beads of j around each one's foot on j's axis.
SHAKEN_VECTOR_CLONES
void lanes_safe_time(const LaneInput& in, const float* offset_i, const float* radius_i, const BeadLanes& j,
                     float* safe) {
  constexpr int kLanes = BeadLanes::kLanes;
  alignas(64) float x[kLanes], y[kLanes], z[kLanes], nearest[kLanes];
  const float beyond = (static_cast<float>(j.reach) + 0.5F) * j.pitch;
  for (int a = 0; a < kLanes; ++a) {
    x[a] = in.D[0] - offset_i[a] * in.n_i[0];
    y[a] = in.D[1] - offset_i[a] * in.n_i[1];
    z[a] = in.D[2] - offset_i[a] * in.n_i[2];
    const float foot = -(x[a] * in.n_j[0] + y[a] * in.n_j[1] + z[a] * in.n_j[2]);
    const float place = (foot + j.half_length) / j.pitch;
    const float low = place > 0.0F ? place : 0.0F;
    const float inside = low < j.last ? low : j.last;
    nearest[a] = static_cast<float>(static_cast<int>(inside + 0.5F));
    // beads of j that are not tried below are at least this far along its axis
    const float across2 = x[a] * x[a] + y[a] * y[a] + z[a] * z[a] - foot * foot;
    const float far =
        std::sqrt((across2 > 0.0F ? across2 : 0.0F) + beyond * beyond) - radius_i[a] - j.max_radius - in.gap_margin;
    safe[a] = (far > 0.0F ? far : 0.0F) / in.fastest;
  }
  for (int k = -j.reach; k <= j.reach; ++k) {
    for (int a = 0; a < kLanes; ++a) {
      const float index = nearest[a] + static_cast<float>(k);
      const float low = index > 0.0F ? index : 0.0F;
      const float s_j = (low < j.last ? low : j.last) * j.pitch - j.half_length;
      const float abs_s_j = s_j < 0.0F ? -s_j : s_j;
      const float s_i = offset_i[a];
      const float abs_s_i = s_i < 0.0F ? -s_i : s_i;
      const float rx = x[a] + s_j * in.n_j[0];
      const float ry = y[a] + s_j * in.n_j[1];
      const float rz = z[a] + s_j * in.n_j[2];
      const float distance = std::sqrt(rx * rx + ry * ry + rz * rz);
      const float vx = in.v[0] + s_j * in.turn_j[0] - s_i * in.turn_i[0];
      const float vy = in.v[1] + s_j * in.turn_j[1] - s_i * in.turn_i[1];
      const float vz = in.v[2] + s_j * in.turn_j[2] - s_i * in.turn_i[2];
      const float gap = distance - (radius_i[a] + j.mid_radius - j.taper * abs_s_j + in.gap_margin);
      const float rate = (vx * rx + vy * ry + vz * rz) / (distance + 1e-20F) - in.stray;
      const float curvature = abs_s_i * in.bend_i + abs_s_j * in.bend_j;  // of gap >= g + g' t - curvature t^2
      const float open = gap > 0.0F ? gap : 0.0F;
      const float root = std::sqrt(rate * rate + 4.0F * curvature * open);
      // receding: the later root if they are apart, the turning point if they overlap; approaching: the first root
      const float recede = gap > 0.0F ? rate + root : rate;
      const float above = rate > 0.0F ? recede : 2.0F * open;
      const float below = (rate > 0.0F ? 2.0F * curvature : root - rate) + 1e-30F;
      const float time = above / below;
      safe[a] = time < safe[a] ? time : safe[a];
    }
  }
}

}  // namespace

double bead_safe_time(const BeadLanes& i, const FlightState& state_i, const BeadLanes& j, const FlightState& state_j,
                      const Vec3& D, const Allowance& allowance, double horizon) {
  const Vec3 v = state_j.velocity - state_i.velocity;
  const double stray =
      2.0 * allowance.velocity + static_cast<double>(i.half_length + j.half_length) * allowance.precession;
  // second derivative of the directors, also after the precession has strayed by its allowance
  const double turn_i = std::sqrt(state_i.rate2) + allowance.precession;
  const double turn_j = std::sqrt(state_j.rate2) + allowance.precession;
  // no two beads approach faster than this
  const double fastest = v.norm() + i.half_length * turn_i + j.half_length * turn_j + stray + 1e-3;

  LaneInput in;
  for (int c = 0; c < 3; ++c) {
    in.D[c] = static_cast<float>(D[c]);
    in.n_i[c] = static_cast<float>(state_i.director[c]);
    in.n_j[c] = static_cast<float>(state_j.director[c]);
    in.v[c] = static_cast<float>(v[c]);
    in.turn_i[c] = static_cast<float>(state_i.turning[c]);
    in.turn_j[c] = static_cast<float>(state_j.turning[c]);
  }
  in.bend_i = static_cast<float>(0.5 * turn_i * turn_i);
  in.bend_j = static_cast<float>(0.5 * turn_j * turn_j);
  // floats carry 6e-8; a dozen roundings of lengths and of speeds
  in.gap_margin = static_cast<float>(kGapMargin + 1e-6 * (D.norm() + i.half_length + j.half_length));
  in.stray = static_cast<float>(stray + kRateMargin + 2e-6 * fastest);
  in.fastest = static_cast<float>(fastest);

  float safe = static_cast<float>(horizon);
  alignas(64) float lane_safe[BeadLanes::kLanes];
  for (std::size_t first = 0; first < i.offset.size(); first += BeadLanes::kLanes) {
    lanes_safe_time(in, i.offset.data() + first, i.radius.data() + first, j, lane_safe);
    for (const float lane : lane_safe) safe = std::min(safe, lane);
  }
  return static_cast<double>(safe) * (1.0 - 1e-5);
}

}  // namespace shaken
