#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/types.h"
#include "sim/system.h"

namespace shaken {

/// The plates at one instant.
struct PlateState {
  double base;          ///< height of the base [mm]
  double lid;           ///< height of the lid [mm]
  double velocity;      ///< of the base along z [mm/s]
  double lid_velocity;  ///< of the lid along z [mm/s]
  double shift;         ///< of both along their horizontal direction [mm]
  double slide;         ///< velocity of both along it [mm/s]
};

/// How the plates vibrate in the plane.
struct HorizontalMotion {
  double amplitude = 0;  ///< b [mm]
  double phase = 0;      ///< phi, ahead of the vibration along z [rad]
  double angle = 0;      ///< of its direction to the x axis [rad]
};

/// Phases f dt k of an oscillation at whole ticks k, in cycles. Numerics: where the period is a whole number of ticks
/// they repeat themselves exactly; otherwise they are kept modulo 1 in 128-bit fixed point. Neither loses digits.
class TickPhases {
 public:
  TickPhases(double frequency, double dt);

  /// Ticks per period if that is a whole number; 1 if nothing moves; otherwise 0.
  Tick period() const { return period_; }
  double at(Tick k) const;

 private:
  Tick period_ = 0;
  __extension__ unsigned __int128 phase_per_tick_ = 0;  ///< in units of 2^-128 cycles
};

/// Two parallel plates that vibrate together: z_base(t) = a cos(2 pi f t) + a, z_lid = z_base + w
/// (Sharma & Soni 2024, section 2), and, where it is asked for,
/// - x(t) = b cos(2 pi f t + phi) along one direction of the plane: each point of a plate then moves along a line
///   (phi = 0), a circle (a = b, phi = 90 degrees) or an ellipse;
/// - z_base(t) + a2 cos(2 pi f2 t + phi2) + a2, a second vibration;
/// - z_lid(t) = d cos(2 pi f t + psi) + a + a2 + w, a lid that does not move with the base. The gap is w on average.
class PlateMotion {
 public:
  /// amplitude a [mm], frequency f [Hz], gap w [mm], tick dt [s].
  PlateMotion(double amplitude, double frequency, double gap, double dt, const HorizontalMotion& horizontal = {});
  PlateMotion() : PlateMotion(0, 0, 0, 1) {}
  /// Those of a scene.
  explicit PlateMotion(const System& system);
  /// The same for less work, where only the first tick and the largest and least values are asked for.
  static PlateMotion without_ticks(System system);

  PlateState at(Tick k) const {
    if (second_) [[unlikely]]
      return with_second(k);
    return first_at(k);
  }

  /// `seconds` (of either sign) before tick k.
  PlateState before(Tick k, double seconds) const;

  /// Velocity of the base, and of what stands on it; and of the lid [mm/s].
  Vec3 velocity(const PlateState& at) const { return velocity_with(at, at.velocity); }
  Vec3 lid_velocity(const PlateState& at) const { return velocity_with(at, at.lid_velocity); }

  bool lid_moves_apart() const { return lid_.has_value(); }

  /// Largest acceleration of the base and of the lid along z: a (2 pi f)^2, where nothing else is asked for [mm/s^2].
  double peak_acceleration() const;
  double peak_lid_acceleration() const;

  /// Largest speed of either plate along z, and across it [mm/s].
  double peak_speed() const;
  double peak_slide() const { return horizontal_.amplitude * angular_frequency_; }

  /// The least height between the plates there can be [mm].
  double least_gap() const;

  /// Ticks per period of the first vibration if that is a whole number, otherwise 0.
  Tick period_ticks() const { return phases_.period(); }

 private:
  /// Displacement [mm] and velocity [mm/s] of what oscillates.
  struct Moving {
    double place, velocity;
  };
  struct Second {
    double amplitude;
    double angular_frequency;
    double phase;  ///< [rad]
    TickPhases phases;
    std::vector<Moving> table{};  ///< (period)

    Moving at_phase(double cycles) const;
    double peak_acceleration() const { return amplitude * angular_frequency * angular_frequency; }
  };

  void fill_table();
  PlateState at_phase(double cycles) const;
  /// But for the second vibration.
  PlateState first_at(Tick k) const {
    return table_.empty() ? at_phase(phases_.at(k)) : table_[static_cast<std::size_t>(k) % table_.size()];
  }
  Moving second_at(Tick k) const;
  void add_second(PlateState& state, const Moving& second) const;
  PlateState with_second(Tick k) const;
  /// What oscillates about `middle`, `seconds` earlier.
  static Moving moved_back(double middle, const Moving& then, double angular_frequency, double seconds);
  Vec3 velocity_with(const PlateState& at, double upwards) const {
    return {at.slide * direction_.x(), at.slide * direction_.y(), upwards};
  }
  double second_amplitude() const { return second_ ? second_->amplitude : 0.0; }
  double lid_middle() const { return amplitude_ + gap_; }  ///< but for the second vibration

  double amplitude_;
  double angular_frequency_;
  double gap_;
  HorizontalMotion horizontal_;
  Vec2 direction_;
  std::optional<LidMotion> lid_;
  std::optional<Second> second_;
  TickPhases phases_;
  std::vector<PlateState> table_;  ///< (period), but for the second vibration
};

/// The space between the plates at tick 0.
struct PlatesAtStart {
  double base;  ///< height of the base [mm]
  double gap;   ///< height of the lid above it [mm]
};
PlatesAtStart plates_at_start(const System& system);

}  // namespace shaken
