// SPDX-License-Identifier: MIT
#include "sim/motion/plate_safe_time.h"

#include <cmath>

#include "sim/core/vector_clones.h"

namespace shaken {
namespace {

using lanes::Floats;

/// Time for which a bead stays off a plate, or goes on receding from within it, if its acceleration towards the plate
/// never exceeds `pull`.
[[gnu::always_inline]] inline Floats safe_time(const Floats& gap, const Floats& rate, const Floats& pull) {
  const Floats open = lanes::larger(gap, Floats{});
  const Floats root = lanes::sqrt(rate * rate + 2.0F * pull * open);
  // receding: the first time at which it can be back or, in the plate, the time up to which it certainly recedes
  const Floats recede = root + (gap > 0.0F ? rate : Floats{});
  const auto receding = rate > 0.0F;
  const Floats above = receding ? recede : 2.0F * open;
  const Floats below = (receding ? pull : root - rate) + 1e-30F;
  return above / below;
}

struct Constants {
  float half_length, mid_radius, end_radius;
  float gravity, pull_base, pull_lid;
  float dt, per_dt, horizon;
};

/// The plates as each lane sees them.
struct PlatesAt {
  alignas(64) float base[kLanes], lid[kLanes], velocity[kLanes];
};

/// Adds to `safe` (in ticks) what is safe from there on.
SHAKEN_VECTOR_CLONES
void extend(const Constants& k, const PlateLanes& rods, const PlatesAt& plates, float* safe) {
  // floats carry 6e-8; a dozen roundings of lengths and of speeds
  constexpr float kLengthRounding = 1e-6F;
  constexpr float kRateRounding = 2e-6F;
  const float h = k.half_length;
  const Floats velocity = lanes::load(rods.velocity);
  const Floats n_z_rate = lanes::load(rods.n_z_rate);
  const Floats plate_velocity = lanes::load(plates.velocity);
  const Floats base = lanes::load(plates.base);
  const Floats lid = lanes::load(plates.lid);
  const Floats ticks = lanes::load(safe);
  const Floats t = ticks * k.dt;

  const Floats height = lanes::load(rods.z) + (velocity - 0.5F * k.gravity * t) * t;
  const Floats rise = velocity - k.gravity * t - plate_velocity;
  const Floats bend = h * lanes::load(rods.rate2);  // bounds the ends' own acceleration
  const Floats sag = 0.5F * bend * t * t;           // how much further an end may be than its tangent says
  const Floats end = h * (lanes::load(rods.n_z) + n_z_rate * t);
  const Floats end_rate = h * n_z_rate;
  const Floats gap_margin = kLengthRounding * (1.0F + h + lanes::abs(height) + lanes::abs(lid));
  const Floats rate_margin = 1e-4F + kRateRounding * (lanes::abs(velocity) + k.gravity * t +
                                                      lanes::abs(plate_velocity) + lanes::abs(end_rate));
  const Floats above = height - base - gap_margin;  // centre above the base
  const Floats below = lid - height - gap_margin;   // centre below the lid
  const Floats up = rise - rate_margin;
  const Floats down = -rise - rate_margin;
  const Floats end_room = sag + k.end_radius;
  const Floats slow = bend * t;
  const Floats pull_base = k.pull_base + bend;
  const Floats pull_lid = lanes::larger(Floats{}, k.pull_lid + bend);

  Floats time = safe_time(above - k.mid_radius, up, lanes::all(k.pull_base));
  time = lanes::smaller(time, safe_time(below - k.mid_radius, down, lanes::larger(Floats{}, lanes::all(k.pull_lid))));
  time = lanes::smaller(time, safe_time(above + end - end_room, up + end_rate - slow, pull_base));
  time = lanes::smaller(time, safe_time(above - end - end_room, up - end_rate - slow, pull_base));
  time = lanes::smaller(time, safe_time(below - end - end_room, down - end_rate - slow, pull_lid));
  time = lanes::smaller(time, safe_time(below + end - end_room, down + end_rate - slow, pull_lid));
  const Floats more = lanes::truncated(lanes::smaller(time * k.per_dt, lanes::all(k.horizon)));
  lanes::store(safe, lanes::smaller(ticks + more, lanes::all(k.horizon)));
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
  constexpr int kSteps = 3;
  alignas(64) float ticks[kLanes] = {};
  PlatesAt at;
  const auto see = [&](int l, const PlateState& plate) {
    at.base[l] = static_cast<float>(plate.base);
    at.lid[l] = static_cast<float>(plate.lid);
    at.velocity[l] = static_cast<float>(plate.velocity);
  };
  const PlateState first = plates.at(now);
  for (int l = 0; l < kLanes; ++l) see(l, first);
  extend(k, rods, at, ticks);
  for (int step = 1; step < kSteps; ++step) {
    for (int l = 0; l < n; ++l) see(l, plates.at(now + static_cast<Tick>(ticks[l])));
    extend(k, rods, at, ticks);
  }
  for (int l = 0; l < n; ++l) safe[l] = static_cast<Tick>(ticks[l]);
}

}  // namespace shaken
