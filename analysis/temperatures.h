#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/bounded_series.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// What turns velocities of a rod into energies.
struct RodInertia {
  double mass = 0;    ///< [mg]
  double across = 0;  ///< about an axis through the centre, across the rod [mg mm^2]
  double along = 0;   ///< about the rod's axis [mg mm^2]
};

/// Degrees of freedom that have a temperature of their own. u is the horizontal direction along a rod, e the horizontal
/// direction across it, k the direction across the rod that is normal to e: upright, for a rod that lies.
enum class Freedom : std::size_t {
  kHorizontal,  ///< translation in the plane: the mean of x and y
  kVertical,    ///< translation along z
  kAlong,       ///< translation along u
  kAcross,      ///< translation along e
  kTurning,     ///< rotation about k: in the plane
  kTipping,     ///< rotation about e: out of the plane
  kSpinning,    ///< rotation about the rod's own axis
  kRotation,    ///< rotation: the mean over three axes; of a sphere that is all there is to know
};
inline constexpr std::size_t kFreedoms = 8;

/// Granular temperatures, by Freedom: twice the mean kinetic energy of one degree of freedom [pJ].
using Temperatures = std::array<double, kFreedoms>;

/// Granular temperatures of rods of one species at one instant,
///   T = m <(v - <v>)^2> N / (N - 1)   of a component v of the velocity,   T = I <w^2>   of one of the angular velocity
/// (Goldhirsch, Annu. Rev. Fluid Mech. 35, 267 (2003), per degree of freedom and with the mass). <v> is the mean of all
/// rods; the last factor makes up for what it takes of their fluctuations. Of rods that differ, <v> is the velocity of
/// their centre of mass, and m and I stand inside of the means. In thermal equilibrium all are k_B T. A rod
/// exactly upright has neither u nor e: it is left out of what needs them. Translation of a single rod, and what no rod
/// has, is NaN.
/// @param directors, velocities [mm/s], angular_velocities [rad/s]  (n_rods) each
/// @param inertias  (n_rods), or the one that all rods have
Temperatures granular_temperatures(std::span<const Vec3> directors, std::span<const Vec3> velocities,
                                   std::span<const Vec3> angular_velocities, std::span<const RodInertia> inertias);

/// How fast rods are in the plane, at one instant or on average [mm/s].
struct Speeds {
  double rms = 0;   ///< root of the mean square, of which nothing is taken away
  double mean = 0;  ///< mean magnitude
};

/// Temperatures against time, in bounded memory (see BoundedSeries).
class TemperatureSeries : public Saved<TemperatureSeries> {
 public:
  /// Takes a sample at `time` [s], later than all before.
  void accumulate(double time, const Temperatures& sample) { series_.accumulate(time, sample); }

  const std::vector<double>& times() const { return series_.times(); }  ///< (n) [s]
  const std::vector<double>& of(Freedom freedom) const {                ///< (n) [pJ]
    return series_.column(static_cast<std::size_t>(freedom));
  }

  static auto fields(auto& self) { return listed(self.series_); }

 private:
  BoundedSeries<kFreedoms> series_;
};

/// Means of temperatures over samples, and speeds over samples and rods.
class TemperatureStatistics : public Summed<TemperatureStatistics> {
 public:
  /// With the velocities (n_rods) [mm/s] of that instant.
  void accumulate(const Temperatures& sample, std::span<const Vec3> velocities);
  /// NaN without samples.
  Temperatures reduce() const {
    Temperatures means = sums_;
    for (double& mean : means) mean /= static_cast<double>(samples_);
    return means;
  }
  /// NaN without samples.
  Speeds speeds() const;

  static constexpr const char* kName = "TemperatureStatistics";
  static auto fields(auto& self) { return listed(self.samples_, self.sums_, self.squares_, self.speeds_); }

 private:
  std::int64_t samples_ = 0;
  Temperatures sums_{};
  double squares_ = 0, speeds_ = 0;  // means over the rods of each sample [mm^2/s^2], [mm/s]
};

}  // namespace shaken::analysis
