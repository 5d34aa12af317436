// SPDX-License-Identifier: MIT
#include "sim/motion/plate_safe_time.h"

#include <cmath>

#include "sim/core/vector_clones.h"

namespace shaken {
namespace {

inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }

/// Time for which a bead stays off a plate, or goes on receding from within it, if its acceleration towards the plate
/// never exceeds `pull`.
inline float safe_time(float gap, float rate, float pull) {
  const float open = larger(gap, 0.0F);
  const float root = std::sqrt(rate * rate + 2.0F * pull * open);
  // apart: the first time at which it can be back; in the plate: the time up to which it certainly recedes
  const float above = gap > 0.0F ? (rate > 0.0F ? rate + root : 2.0F * open) : larger(rate, 0.0F);
  const float below = (gap > 0.0F && !(rate > 0.0F) ? root - rate : pull) + 1e-30F;
  return above / below;
}

struct Constants {
  float half_length, mid_radius, end_radius;
  float gravity, pull_base, pull_lid;
  float dt, per_dt, horizon;
};

/// The plates as each lane sees them.
struct PlatesAt {
  alignas(64) float base[kPlateLanes], lid[kPlateLanes], velocity[kPlateLanes];
};

/// Adds to `safe` (in ticks) what is safe from there on.
SHAKEN_VECTOR_CLONES
void extend(const Constants& k, const PlateLanes& rods, const PlatesAt& plates, float* safe) {
  // floats carry 6e-8; a dozen roundings of lengths and of speeds
  constexpr float kLengthRounding = 1e-6F;
  constexpr float kRateRounding = 2e-6F;
  const float h = k.half_length;
  for (int l = 0; l < kPlateLanes; ++l) {
    const float t = safe[l] * k.dt;
    const float height = rods.z[l] + (rods.velocity[l] - 0.5F * k.gravity * t) * t;
    const float plate_velocity = plates.velocity[l];
    const float rise = rods.velocity[l] - k.gravity * t - plate_velocity;
    const float bend = h * rods.rate2[l];  // bounds the ends' own acceleration
    const float sag = 0.5F * bend * t * t;  // how much further an end may be than its tangent says
    const float lean = h * std::fabs(rods.n_z_rate[l]);
    const float gap_margin = kLengthRounding * (1.0F + std::fabs(height) + std::fabs(plates.lid[l]) + h);
    const float rate_margin =
        1e-4F + kRateRounding * (std::fabs(rods.velocity[l]) + k.gravity * t + std::fabs(plate_velocity) + lean);
    const float above = height - plates.base[l] - gap_margin;  // centre above the base
    const float below = plates.lid[l] - height - gap_margin;   // centre below the lid
    const float up = rise - rate_margin;
    const float down = -rise - rate_margin;
    const float end = h * (rods.n_z[l] + rods.n_z_rate[l] * t);
    const float end_rate = h * rods.n_z_rate[l];
    const float end_room = sag + k.end_radius;
    const float slow = bend * t;
    const float pull_base = k.pull_base + bend;
    const float pull_lid = larger(0.0F, k.pull_lid + bend);

    float time = safe_time(above - k.mid_radius, up, k.pull_base);
    time = smaller(time, safe_time(below - k.mid_radius, down, larger(0.0F, k.pull_lid)));
    time = smaller(time, safe_time(above + end - end_room, up + end_rate - slow, pull_base));
    time = smaller(time, safe_time(above - end - end_room, up - end_rate - slow, pull_base));
    time = smaller(time, safe_time(below - end - end_room, down - end_rate - slow, pull_lid));
    time = smaller(time, safe_time(below + end - end_room, down + end_rate - slow, pull_lid));
    const float more = smaller(time * k.per_dt, k.horizon);
    safe[l] = smaller(safe[l] + static_cast<float>(static_cast<int>(more)), k.horizon);
  }
}

}  // namespace

void plate_safe_ticks(const Species& species, const PlateMotion& plates, const PlateLanes& rods, int n, double gravity,
                      double dt, Tick now, Tick horizon, Tick* safe) {
  const Constants k{static_cast<float>(species.half_length),
                    static_cast<float>(species.mid_radius),
                    static_cast<float>(species.n_beads() > 1 ? species.end_radius : species.mid_radius),
                    static_cast<float>(gravity),
                    static_cast<float>((plates.peak_acceleration() + gravity) * (1.0 + 1e-6)),
                    static_cast<float>((plates.peak_acceleration() - gravity) + 1e-6 * (plates.peak_acceleration() + gravity)),
                    static_cast<float>(dt),
                    static_cast<float>((1.0 - 1e-5) / dt),
                    static_cast<float>(horizon)};
  constexpr int kSteps = 4;
  alignas(64) float ticks[kPlateLanes] = {};
  PlatesAt at;
  for (int step = 0; step < kSteps; ++step) {
    for (int l = 0; l < kPlateLanes; ++l) {
      const PlateState plate = plates.at(now + static_cast<Tick>(l < n ? ticks[l] : 0.0F));
      at.base[l] = static_cast<float>(plate.base);
      at.lid[l] = static_cast<float>(plate.lid);
      at.velocity[l] = static_cast<float>(plate.velocity);
    }
    extend(k, rods, at, ticks);
  }
  for (int l = 0; l < n; ++l) safe[l] = static_cast<Tick>(ticks[l]);
}

}  // namespace shaken
