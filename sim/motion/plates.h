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
  double velocity;  ///< of both [mm/s]
};

/// Two horizontal plates that vibrate together: z_base(t) = a cos(2 pi f t) + a, z_lid = z_base + w
/// (Sharma & Soni 2024, section 2).
class PlateMotion {
 public:
  /// amplitude a [mm], frequency f [Hz], gap w [mm], tick dt [s].
  PlateMotion(double amplitude, double frequency, double gap, double dt);
  PlateMotion() : PlateMotion(0, 0, 0, 1) {}

  /// Numerics: where the period is a whole number of ticks, a table over one period; otherwise the phase f dt k is kept
  /// modulo 1 in 128-bit fixed point. Neither loses digits with k.
  PlateState at(Tick k) const {
    return table_.empty() ? at_phase_of(k) : table_[static_cast<std::size_t>(k) % table_.size()];
  }

  /// `seconds` (of either sign) before an instant at which the plates were `then`.
  PlateState before(const PlateState& then, double seconds) const;

  /// Largest acceleration of the plates, a (2 pi f)^2 [mm/s^2].
  double peak_acceleration() const { return amplitude_ * angular_frequency_ * angular_frequency_; }

  /// Largest speed of the plates [mm/s].
  double peak_speed() const { return amplitude_ * angular_frequency_; }

  /// Ticks per period if that is a whole number, otherwise 0.
  Tick period_ticks() const { return static_cast<Tick>(table_.size()); }

 private:
  PlateState at_phase(double cycles) const;
  PlateState at_phase_of(Tick k) const;

  double amplitude_;
  double angular_frequency_;
  double gap_;
  __extension__ unsigned __int128 phase_per_tick_ = 0;  ///< in units of 2^-128 cycles
  std::vector<PlateState> table_;
};

}  // namespace shaken
