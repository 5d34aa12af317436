// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "analysis/blocked.h"
#include "analysis/tilt.h"
#include "sim/simulation.h"

namespace shaken::bench {

/// What is averaged over time, one number per sample.
struct Observable {
  const char* name;
  const char* unit;
  const char* title;  ///< as people write it
  bool has_limit;     ///< as dt -> 0; a rod at rest on a plate gets an impulse at every tick, so impulses have none
};
inline constexpr std::array<Observable, 10> kObservables{{
    {"T_xy", "mm^2/s^2", "temperature in the plane", true},  // mean square of a velocity component: per mass
    {"T_z", "mm^2/s^2", "temperature upright", true},
    {"T_rot", "rad^2/s^2", "temperature of rotation", true},  // of an angular velocity across the rod
    {"S", "1", "order S", true},
    {"rms_n_z", "1", "rms tilt n_z", true},
    {"drift", "mm/s", "drift against the tilt", true},  // mean velocity along the rod, of those with 0.1 < |n_z| < 0.25
    {"msd", "mm^2", "square displacement in 20.7 ms", true},  // in the plane, after kLag
    {"hit", "1", "share of rods hit within 64 μs", true},     // kRecently
    {"rod_impulses", "1/s", "impulses between rods", false},  // per rod
    {"plate_impulses", "1/s", "impulses from plates", false},
}};

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

  /// Of the observable of that name; empty where it could not be told.
  const std::vector<double>& values(const std::string& name) const { return values_.at(name); }
  const analysis::Blocked<analysis::TiltVelocity>& tilt() const { return tilt_; }

 private:
  std::map<std::string, std::vector<double>> values_;
  analysis::Blocked<analysis::TiltVelocity> tilt_;
  std::deque<std::vector<Vec2>> places_;  ///< unwrapped, of the last kLagSamples samples
  Counters last_;
};

}  // namespace shaken::bench
