#include "sim/bounds/plate_safe_time.h"

#include <cmath>

#include "sim/bounds/margins.h"

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

/// A bead that may be the lowest or the highest of its rod.
struct OuterBead {
  float offset, size;  ///< along the rod from its centre, and without sign [mm]
  float radius;
};

struct Constants {
  OuterBead beads[kMostBeads];
  int n_beads;
  bool has_base, has_lid;
  float half_length;
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
  alignas(64) float base[kLanes], lid[kLanes], velocity[kLanes], velocity_apart[kLanes];
  const float* lid_velocity;  ///< one of the two: of a lid that moves with the base, or by itself
};

/// Adds to `safe` (in ticks) what is safe from there on.
struct PlateKernel {
  const Constants& k;
  const PlateLanes& rods;
  const PlatesAt& plates;
  float* safe;
  int n;

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < n; l += W) extend<W>(l);
  }

  template <int W>
  SHAKEN_INLINE void extend(int l) const {
    using F = lanes::Floats<W>;
    const float h = k.half_length;
    const F velocity = lanes::load<W>(rods.velocity + l);
    const F n_z_rate = lanes::load<W>(rods.n_z_rate + l);
    const F base_velocity = lanes::load<W>(plates.velocity + l);
    const F lid_velocity = lanes::load<W>(plates.lid_velocity + l);
    const F base = lanes::load<W>(plates.base + l);
    const F lid = lanes::load<W>(plates.lid + l);
    const F ticks = lanes::load<W>(safe + l);
    const F t = ticks * k.dt;

    const F height = lanes::load<W>(rods.z + l) + (velocity - 0.5F * k.gravity * t) * t;
    const F upwards = velocity - k.gravity * t;
    const F rate2 = lanes::load<W>(rods.rate2 + l);
    const F n_z = lanes::load<W>(rods.n_z + l) + n_z_rate * t;
    const F speed = lanes::abs(velocity) + k.gravity * t;  // what it flies up and falls down again is rounded, too
    const F gap_margin = margins::kPlateLength * (1.0F + h + lanes::abs(height) + lanes::abs(lid) + speed * t);
    const F rates = speed + h * lanes::abs(n_z_rate);
    const auto rate_margin = [&](const F& plate_velocity) {
      return margins::kPlateSpeed + margins::kPlateRate * (rates + lanes::abs(plate_velocity));
    };
    const F above = height - base - gap_margin;  // centre above the base
    const F below = lid - height - gap_margin;   // centre below the lid
    const F up = upwards - base_velocity - rate_margin(base_velocity);
    const F down = lid_velocity - upwards - rate_margin(lid_velocity);
    F time = lanes::all<W>(k.horizon * k.dt);
    for (int b = 0; b < k.n_beads; ++b) {
      const OuterBead& bead = k.beads[b];
      const F bend = bead.size * rate2;                  // bounds the bead's own acceleration
      const F room = bead.radius + 0.5F * bend * t * t;  // it may be that much further than its tangent says
      const F swing = bend * t;
      const F ahead = bead.offset * n_z;
      const F ahead_rate = bead.offset * n_z_rate;
      const F pull_lid = lanes::not_below_zero(k.pull_lid + bend);
      if (k.has_base)
        time = lanes::smaller(time,
                              safe_time_off_base(k, above + ahead - room, up + ahead_rate - swing, k.pull_base + bend));
      if (k.has_lid) time = lanes::smaller(time, safe_time(below - ahead - room, down - ahead_rate - swing, pull_lid));
    }
    const F more = lanes::truncated(lanes::smaller(time * k.per_dt, lanes::all<W>(k.horizon)));
    lanes::store(safe + l, lanes::smaller(ticks + more, lanes::all<W>(k.horizon)));
  }
};

}  // namespace

void plate_safe_ticks(const Species& species, const PlateMotion& plates, const PlateLanes& rods, int n, double gravity,
                      double dt, Tick now, Tick horizon, Tick* safe, PlatesThere there) {
  Constants k;
  k.n_beads = 0;
  for (const int b : species.outer_beads) {
    const auto offset = static_cast<float>(species.bead_offset[b]);
    // what is bounded by the size is rounded
    k.beads[k.n_beads++] = {offset, std::abs(offset) * (1.0F + static_cast<float>(margins::kPlateConstants)),
                            static_cast<float>(species.bead_radius[b])};
  }
  k.has_base = there.base;
  k.has_lid = there.lid;
  k.half_length = static_cast<float>(species.half_length);
  k.gravity = static_cast<float>(gravity);
  k.pull_base = static_cast<float>((plates.peak_acceleration() + gravity) * (1.0 + margins::kPlateConstants));
  k.pull_lid = static_cast<float>((plates.peak_lid_acceleration() - gravity) +
                                  margins::kPlateConstants * (plates.peak_lid_acceleration() + gravity));
  k.dt = static_cast<float>(dt);
  k.per_dt = static_cast<float>((1.0 - static_cast<double>(margins::kTime)) / dt);
  k.horizon = static_cast<float>(horizon);
  k.half_fall = static_cast<float>(there.rest.half_fall * (1.0 + margins::kPlateConstants));
  k.rise_rate = static_cast<float>(there.rest.rise_rate * (1.0 + margins::kPlateConstants));
  constexpr int kSteps = 3;
  alignas(64) float ticks[kLanes] = {};
  PlatesAt at;
  const bool moves_apart = plates.lid_moves_apart();
  at.lid_velocity = moves_apart ? at.velocity_apart : at.velocity;
  const auto see = [&](int l, const PlateState& plate) {
    at.base[l] = static_cast<float>(plate.base);
    at.lid[l] = static_cast<float>(plate.lid);
    at.velocity[l] = static_cast<float>(plate.velocity);
    if (moves_apart) at.velocity_apart[l] = static_cast<float>(plate.lid_velocity);
  };
  const PlateState first = plates.at(now);
  for (int l = 0; l < kLanes; ++l) see(l, first);
  lanes::with_widest_vectors(PlateKernel{k, rods, at, ticks, n});
  for (int step = 1; step < kSteps; ++step) {
    for (int l = 0; l < n; ++l) see(l, plates.at(now + static_cast<Tick>(ticks[l])));
    lanes::with_widest_vectors(PlateKernel{k, rods, at, ticks, n});
  }
  for (int l = 0; l < n; ++l) safe[l] = static_cast<Tick>(ticks[l]);
}

}  // namespace shaken
