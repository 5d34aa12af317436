#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/bounded_series.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

/// The pressure tensor of rods in the plane of the plates: momentum that crosses a line of unit length in unit time,
///   P_ab = (1/A) [ N/(N-1) sum_i m_i (v_ia - V_a) (v_ib - V_b)  +  (1/t) sum r_a J_b ]
/// over all N rods i, with V the velocity of their centre of mass (N/(N-1) makes up for what V takes of the
/// fluctuations, as in granular temperatures), and over all impacts of two rods during the time t: J is the impulse on
/// the second rod, r the way to its centre from that of the first (Allen & Tildesley, Computer Simulation of Liquids
/// (2017), section 2.4, with the impulse in place of the force). In the plane [pJ/mm^2 = uN/m].
namespace shaken::analysis {

/// xx, xy, yx, yy.
using PlaneTensor = std::array<double, 4>;

/// sum m (v - V)(v - V), without the factor N/(N-1), of rods of masses `masses` [mg] and velocities `velocities`
/// [mm/s], (n_rods) each [pJ].
PlaneTensor momentum_flux(std::span<const double> masses, std::span<const Vec3> velocities);

/// What the pressure of a run is made of, at one instant.
struct StressTotals {
  PlaneTensor momentum_flux{};  ///< at this instant [pJ]
  PlaneTensor virial{};         ///< sum of r_a J_b over all impacts since the start [pJ s]
};

/// Parts of the pressure, along and across the director [pJ/mm^2].
struct Pressure {
  double along = 0, across = 0;  ///< of kinetic and collisional part together
  double kinetic = 0;            ///< mean of both directions
  double collisional = 0;        ///< the same
};

/// Sums over stretches of time.
class PressureSums : public Summed<PressureSums> {
 public:
  /// Means of `duration` [s] in the frame of a director at the angle `director` [rad].
  void accumulate(double duration, const PlaneTensor& kinetic, const PlaneTensor& collisional, double director);
  /// The pressure of `n_rods`. NaN without any time, and with a kinetic part in it of a single rod.
  Pressure reduce(std::size_t n_rods) const;

  static constexpr const char* kName = "PressureSums";
  static auto fields(auto& self) { return listed(self.time_, self.kinetic_, self.collisional_); }

 private:
  double time_ = 0;                  // [s]
  std::array<double, 2> kinetic_{};  // along and across, times time
  std::array<double, 2> collisional_{};
};

/// The pressure tensor against time: each sample is of the time since the one before, in which impacts are counted; the
/// kinetic part is the mean of both ends.
class StressSeries : public Saved<StressSeries> {
 public:
  explicit StressSeries(std::size_t n_rods) : n_rods_(n_rods) {}

  /// What there is at `time` [s], later than all before, of rods that have `area` [mm^2] to share.
  /// @param director  angle of the director to x [rad]
  void accumulate(double time, const StressTotals& totals, double area, double director);

  const std::vector<double>& times() const { return series_.times(); }  ///< (n) ends of these times [s]
  /// (n) component k of the kinetic part [pJ/mm^2]
  std::vector<double> kinetic(std::size_t k) const;
  /// (n) component k of the collisional part [pJ/mm^2]
  const std::vector<double>& collisional(std::size_t k) const { return series_.column(4 + k); }
  /// By the beginning of these times.
  const Blocked<PressureSums>& sums() const { return sums_; }

  static constexpr const char* kName = "StressSeries";
  static auto fields(auto& self) {
    return listed(self.samples_, self.time_, self.last_flux_, self.last_virial_, self.series_, self.sums_);
  }

 private:
  std::size_t n_rods_;
  std::int64_t samples_ = 0;
  double time_ = 0;  // of the last
  PlaneTensor last_flux_{}, last_virial_{};
  BoundedSeries<8> series_;
  Blocked<PressureSums> sums_{PressureSums()};
};

}  // namespace shaken::analysis
