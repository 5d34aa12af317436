// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "analysis/blocked.h"
#include "analysis/tilt.h"
#include "sim/simulation.h"

namespace shaken::bench {

/// What is averaged over time, one number per sample.
enum class Observable {
  kTemperatureXy,  ///< mean square of a velocity component in the plane: granular temperature per mass
  kTemperatureZ,   ///< and of the upright one
  kRotation,       ///< mean square of an angular velocity across the rod, as hardly a rod spins about its axis
  kOrder,          ///< S
  kTilt,           ///< root mean square of n_z
  kDrift,          ///< mean velocity along the rod against its tilt, of rods with 0.1 < |n_z| < 0.25
  kDisplacement,   ///< mean square displacement in the plane after kLag
  kHit,            ///< share of rods hit within the last kRecently
  kRodImpulses,    ///< impulses between rods per rod and second
  kPlateImpulses,  ///< impulses from plates per rod and second
};
inline constexpr std::size_t kObservables = 10;

struct ObservableInfo {
  const char* name;
  const char* unit;
  const char* title;  ///< as people write it
  bool has_limit;     ///< as dt -> 0; a rod at rest on a plate gets an impulse at every tick, so impulses have none
};
/// By Observable.
inline constexpr std::array<ObservableInfo, kObservables> kObservableInfo{
    {{"T_xy", "mm^2/s^2", "temperature in the plane", true},
     {"T_z", "mm^2/s^2", "temperature upright", true},
     {"T_rot", "rad^2/s^2", "temperature of rotation", true},
     {"S", "1", "order S", true},
     {"rms_n_z", "1", "rms tilt n_z", true},
     {"drift", "mm/s", "drift against the tilt", true},
     {"msd", "mm^2", "square displacement in 20.7 ms", true},
     {"hit", "1", "share of rods hit within 64 μs", true},
     {"rod_impulses", "1/s", "impulses between rods", false},
     {"plate_impulses", "1/s", "impulses from plates", false}}};

/// Samples of one run, taken every kEvery.
class ObservableSeries {
 public:
  /// Not a simple fraction of the plates' 5 ms, so that samples see all their phases in turn; a whole number of any
  /// tick that is 64 us halved some times [s].
  static constexpr double kEvery = 27 * 64e-6;
  static constexpr int kLagSamples = 12;
  static constexpr double kLag = kLagSamples * kEvery;  ///< 20.7 ms
  static constexpr double kRecently = 64e-6;            ///< [s]

  ObservableSeries();
  void sample(const Simulation& simulation);

  const std::vector<double>& values(Observable of) const { return values_[static_cast<std::size_t>(of)]; }
  const analysis::Blocked<analysis::TiltVelocity>& tilt() const { return tilt_; }

 private:
  void add(Observable of, double value) { values_[static_cast<std::size_t>(of)].push_back(value); }

  std::array<std::vector<double>, kObservables> values_;
  analysis::Blocked<analysis::TiltVelocity> tilt_;
  std::deque<std::vector<Vec2>> places_;  ///< unwrapped, of the last kLagSamples samples
  Counters last_;
};

}  // namespace shaken::bench
