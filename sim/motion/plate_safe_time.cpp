// SPDX-License-Identifier: MIT
#include "sim/motion/plate_safe_time.h"

#include <algorithm>
#include <cmath>

namespace shaken {
namespace {

constexpr double kGapMargin = 1e-9;   ///< [mm]
constexpr double kRateMargin = 1e-6;  ///< [mm/s]

/// Time for which a bead stays off a plate, or goes on receding from within it, if its acceleration towards the plate
/// never exceeds `pull`.
double safe_time(double gap, double rate, double pull) {
  rate -= kRateMargin;
  gap -= kGapMargin;
  if (gap > 0) {
    const double denominator = std::sqrt(rate * rate + 2.0 * pull * gap) - rate;
    return denominator > 0 ? 2.0 * gap / denominator : 1e30;
  }
  if (rate <= 0) return 0;
  return pull > 0 ? rate / pull : 1e30;
}

}  // namespace

Tick plate_safe_ticks(const Species& species, const PlateMotion& plates, double z, double v_z, double n_z,
                      double n_z_rate, double rate2, double gravity, double dt, Tick now, Tick horizon) {
  const double h = species.half_length;
  const double bend = h * rate2;  // bounds the ends' own acceleration
  const double pull_base = plates.peak_acceleration() + gravity;
  const double pull_lid = plates.peak_acceleration() - gravity;
  constexpr int kSteps = 4;

  Tick safe = 0;
  for (int step = 0; step < kSteps && safe < horizon; ++step) {
    const double t = static_cast<double>(safe) * dt;
    const PlateState plate = plates.at(now + safe);
    const double height = z + (v_z - 0.5 * gravity * t) * t;
    const double rise = v_z - gravity * t - plate.velocity;
    const double above = height - plate.base;  // centre above the base
    const double below = plate.lid - height;   // centre below the lid
    const double sag = 0.5 * bend * t * t;     // how much further an end may be than its tangent says
    const double end = h * (n_z + n_z_rate * t);
    const double end_rate = h * n_z_rate;

    // centre bead
    double time = std::min(safe_time(above - species.mid_radius, rise, pull_base),
                           safe_time(below - species.mid_radius, -rise, std::max(0.0, pull_lid)));
    if (h > 0) {
      for (const double side : {1.0, -1.0}) {
        const double up = side * end;
        const double up_rate = side * end_rate;
        time = std::min(time,
                        safe_time(above + up - sag - species.end_radius, rise + up_rate - bend * t, pull_base + bend));
        time = std::min(time, safe_time(below - up - sag - species.end_radius, -rise - up_rate - bend * t,
                                        std::max(0.0, pull_lid + bend)));
      }
    }
    const Tick more = static_cast<Tick>(std::min(time / dt * (1.0 - 1e-12), static_cast<double>(horizon)));
    if (more == 0) break;
    safe = std::min(horizon, safe + more);
  }
  return safe;
}

}  // namespace shaken
