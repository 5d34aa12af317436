// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "base/core/types.h"

namespace shaken {

/// The plates at one instant.
struct PlateState {
  double base;      ///< height of the base [mm]
  double lid;       ///< height of the lid [mm]
  double velocity;  ///< of both along z [mm/s]
  double shift;     ///< of both along their horizontal direction [mm]
  double slide;     ///< velocity of both along it [mm/s]
};

/// How the plates vibrate in the plane.
struct HorizontalMotion {
  double amplitude = 0;  ///< b [mm]
  double phase = 0;      ///< phi, ahead of the vibration along z [rad]
  double angle = 0;      ///< of its direction to the x axis [rad]
};

/// Two horizontal plates that vibrate together: z_base(t) = a cos(2 pi f t) + a, z_lid = z_base + w
/// (Sharma & Soni 2024, section 2), and, where it is asked for, x(t) = b cos(2 pi f t + phi) along one direction of the
/// plane. Each point of a plate then moves along a line (phi = 0), a circle (a = b, phi = 90 degrees) or an ellipse.
class PlateMotion {
 public:
  /// amplitude a [mm], frequency f [Hz], gap w [mm], tick dt [s].
  PlateMotion(double amplitude, double frequency, double gap, double dt, const HorizontalMotion& horizontal = {});
  PlateMotion() : PlateMotion(0, 0, 0, 1) {}

  /// Numerics: where the period is a whole number of ticks, a table over one period; otherwise the phase f dt k is kept
  /// modulo 1 in 128-bit fixed point. Neither loses digits with k.
  PlateState at(Tick k) const {
    return table_.empty() ? at_phase_of(k) : table_[static_cast<std::size_t>(k) % table_.size()];
  }

  /// `seconds` (of either sign) before an instant at which the plates were `then`.
  PlateState before(const PlateState& then, double seconds) const;

  /// Velocity of the plates [mm/s].
  Vec3 velocity(const PlateState& at) const {
    return {at.slide * direction_.x(), at.slide * direction_.y(), at.velocity};
  }

  /// Largest acceleration of the plates along z, a (2 pi f)^2 [mm/s^2].
  double peak_acceleration() const { return amplitude_ * angular_frequency_ * angular_frequency_; }

  /// Largest speed of the plates along z, and across it [mm/s].
  double peak_speed() const { return amplitude_ * angular_frequency_; }
  double peak_slide() const { return horizontal_.amplitude * angular_frequency_; }

  /// Ticks per period if that is a whole number, otherwise 0.
  Tick period_ticks() const { return static_cast<Tick>(table_.size()); }

 private:
  PlateState at_phase(double cycles) const;
  PlateState at_phase_of(Tick k) const;

  double amplitude_;
  double angular_frequency_;
  double gap_;
  HorizontalMotion horizontal_;
  Vec2 direction_;
  __extension__ unsigned __int128 phase_per_tick_ = 0;  ///< in units of 2^-128 cycles
  std::vector<PlateState> table_;
};

}  // namespace shaken
