// SPDX-License-Identifier: MIT
#include "sim/motion/plate_safe_time.h"

#include <cmath>

namespace shaken {
namespace {

/// Time for which a bead stays off a plate, or goes on receding from within it, if its acceleration towards the plate
/// never exceeds `pull`.
template <class F>
SHAKEN_INLINE F safe_time(const F& gap, const F& rate, const F& pull) {
  const F open = lanes::not_below_zero(gap);
  const F root = lanes::sqrt(rate * rate + 2.0F * pull * open);
  // receding: the first time at which it can be back or, in the plate, the time up to which it certainly recedes
  const F recede = root + (gap > 0.0F ? rate : F{});
  const auto receding = rate > 0.0F;
  const F above = receding ? recede : 2.0F * open;
  const F below = (receding ? pull : root - rate) + 1e-30F;
  return above / below;
}

struct Constants {
  float half_length, mid_radius;
  float head_length, head_radius, tail_length, tail_radius;
  float gravity, pull_base, pull_lid;
  float dt, per_dt, horizon;
  float half_fall, rise_rate;
};

/// The same for the base: in it, safe only for as long as the bead leaves faster than it must.
template <class F>
SHAKEN_INLINE F safe_time_off_base(const Constants& k, const F& gap, const F& rate, const F& pull) {
  return safe_time(gap, F(gap > 0.0F ? rate : rate - k.half_fall + k.rise_rate * gap), pull);
}

/// The plates as each lane sees them.
struct PlatesAt {
  alignas(64) float base[kLanes], lid[kLanes], velocity[kLanes];
};

/// Adds to `safe` (in ticks) what is safe from there on.
struct PlateKernel {
  const Constants& k;
  const PlateLanes& rods;
  const PlatesAt& plates;
  float* safe;

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < kLanes; l += W) extend<W>(l);
  }

  template <int W>
  SHAKEN_INLINE void extend(int l) const {
    using F = lanes::Floats<W>;
    // floats carry 6e-8; a dozen roundings of lengths and of speeds
    constexpr float kLengthRounding = 1e-6F;
    constexpr float kRateRounding = 2e-6F;
    const float h = k.half_length;
    const F velocity = lanes::load<W>(rods.velocity + l);
    const F n_z_rate = lanes::load<W>(rods.n_z_rate + l);
    const F plate_velocity = lanes::load<W>(plates.velocity + l);
    const F base = lanes::load<W>(plates.base + l);
    const F lid = lanes::load<W>(plates.lid + l);
    const F ticks = lanes::load<W>(safe + l);
    const F t = ticks * k.dt;

    const F height = lanes::load<W>(rods.z + l) + (velocity - 0.5F * k.gravity * t) * t;
    const F rise = velocity - k.gravity * t - plate_velocity;
    const F bend = h * lanes::load<W>(rods.rate2 + l);  // bounds the ends' own acceleration
    const F sag = 0.5F * bend * t * t;                  // how much further an end may be than its tangent says
    const F n_z = lanes::load<W>(rods.n_z + l) + n_z_rate * t;
    const F head = k.head_length * n_z;  // of the head's bead above the centre
    const F tail = k.tail_length * n_z;  // of the tail's below
    const F head_rate = k.head_length * n_z_rate;
    const F tail_rate = k.tail_length * n_z_rate;
    const F gap_margin = kLengthRounding * (1.0F + h + lanes::abs(height) + lanes::abs(lid));
    const F rate_margin = 1e-4F + kRateRounding * (lanes::abs(velocity) + k.gravity * t + lanes::abs(plate_velocity) +
                                                   h * lanes::abs(n_z_rate));
    const F above = height - base - gap_margin;  // centre above the base
    const F below = lid - height - gap_margin;   // centre below the lid
    const F up = rise - rate_margin;
    const F down = -rise - rate_margin;
    const F head_room = sag + k.head_radius;
    const F tail_room = sag + k.tail_radius;
    const F slow = bend * t;
    const F pull_base = k.pull_base + bend;
    const F pull_lid = lanes::not_below_zero(k.pull_lid + bend);

    F time = safe_time_off_base(k, above - k.mid_radius, up, lanes::all<W>(k.pull_base));
    time =
        lanes::smaller(time, safe_time(below - k.mid_radius, down, lanes::not_below_zero(lanes::all<W>(k.pull_lid))));
    time = lanes::smaller(time, safe_time_off_base(k, above + head - head_room, up + head_rate - slow, pull_base));
    time = lanes::smaller(time, safe_time_off_base(k, above - tail - tail_room, up - tail_rate - slow, pull_base));
    time = lanes::smaller(time, safe_time(below - head - head_room, down - head_rate - slow, pull_lid));
    time = lanes::smaller(time, safe_time(below + tail - tail_room, down + tail_rate - slow, pull_lid));
    const F more = lanes::truncated(lanes::smaller(time * k.per_dt, lanes::all<W>(k.horizon)));
    lanes::store(safe + l, lanes::smaller(ticks + more, lanes::all<W>(k.horizon)));
  }
};

}  // namespace

void plate_safe_ticks(const Species& species, const PlateMotion& plates, const PlateLanes& rods, int n, double gravity,
                      double dt, Tick now, Tick horizon, Tick* safe, RestSpeed rest) {
  const Constants k{
      static_cast<float>(species.half_length),
      static_cast<float>(species.mid_radius),
      static_cast<float>(species.head.length),
      static_cast<float>(species.head.radius),
      static_cast<float>(species.tail.length),
      static_cast<float>(species.tail.radius),
      static_cast<float>(gravity),
      static_cast<float>((plates.peak_acceleration() + gravity) * (1.0 + 1e-6)),
      static_cast<float>((plates.peak_acceleration() - gravity) + 1e-6 * (plates.peak_acceleration() + gravity)),
      static_cast<float>(dt),
      static_cast<float>((1.0 - 1e-5) / dt),
      static_cast<float>(horizon),
      static_cast<float>(rest.half_fall * (1.0 + 1e-6)),
      static_cast<float>(rest.rise_rate * (1.0 + 1e-6))};
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
  lanes::with_widest_vectors(PlateKernel{k, rods, at, ticks});
  for (int step = 1; step < kSteps; ++step) {
    for (int l = 0; l < n; ++l) see(l, plates.at(now + static_cast<Tick>(ticks[l])));
    lanes::with_widest_vectors(PlateKernel{k, rods, at, ticks});
  }
  for (int l = 0; l < n; ++l) safe[l] = static_cast<Tick>(ticks[l]);
}

}  // namespace shaken
