#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/saved.h"
#include "analysis/lags/lag_average.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Products of the velocities of each rod in two samples.
struct VelocityKernel {
  static constexpr std::string_view kName = "VelocityCorrelation";
  static constexpr std::size_t kColumns = 2;  // v_x, v_y [mm/s]
  /// Along and across the director at the origin time [mm^2/s^2]; of the unit vector of the velocity at the origin time
  /// with that of the later one, and with the later velocity [mm/s]. A rod at rest has no unit vector and adds nothing.
  static constexpr std::size_t kQuantities = 4;
  static constexpr bool kLagZero = true;
  static LagPair<kQuantities> between(const LagFrame<kColumns>& origin, const LagFrame<kColumns>& later);
};

/// Velocity autocorrelation against lag; all of shape (lags met so far), lag 0 included. 1 at lag 0; NaN where nothing
/// moves.
struct VelocityCurve {
  std::vector<double> lag;  ///< [s], rising from 0
  EstimateCurve c_v;        ///< <v(t0) . v(t0 + t)> / <v^2>, in the plane
  EstimateCurve along;      ///< of the component along the nematic director at t0, over its own mean square
  EstimateCurve across;     ///< of the component across it
  /// The same, not normalised [mm^2/s^2]; at lag 0 the mean squares.
  EstimateCurve product, product_along, product_across;
  /// <u(t0) . u(t0 + t)> of the unit vectors u of the velocities: how long a way keeps its direction.
  EstimateCurve direction;
};

struct VelocitySummary {
  Estimate correlation_time;  ///< integral of C_v (trapezia) up to its first zero [s]; NaN if it has none
  Estimate decay_time;        ///< at which C_v falls to 1/e (see decay_time) [s]; NaN if it does not
  Estimate mean_square;       ///< <v^2> of the averaged velocity, in the plane [mm^2/s^2]
  Estimate mean_square_along, mean_square_across;  ///< of its components [mm^2/s^2]
  /// How long a rod keeps its direction: the integral of <u(t0) . u(t0 + t)> (trapezia) up to where it first falls to
  /// 1/e^2, over 1 - 1/e^2: of an exponential that is the whole integral, its decay time [s]. What is slower and lies
  /// below 1/e^2 does not count. NaN where it does not fall so far.
  Estimate persistence_time;
  /// How far it gets in that direction, the mean way along u(t0): the same of <u(t0) . v(t0 + t)>, up to 1/e^2 of its
  /// value at lag 0 [mm] (the projection on the first bond that defines a polymer's persistence length: Flory,
  /// Statistical Mechanics of Chain Molecules, 1969, ch. IV). Up to a zero, as once, both would be of what noise does
  /// at long lags, and their errors, which do not know of that, a quarter too small.
  Estimate persistence_length;
};

/// Autocorrelation of velocities averaged over a window, v(t) = (r(t + window) - r(t)) / window, as Sharma & Soni 2024
/// average over 400 ms; at the lags of LagAverage and in 128 bytes per level and rod, and the positions of one window.
/// Averaging leaves its mark: of a random walk C_v(t) = 1 - t / window up to the window, where it falls to 0, so that
/// persistence times below a window are the window's.
class VelocityCorrelation : public Saved<VelocityCorrelation> {
 public:
  /// `interval`: time between successive accumulate calls [s]. The window is rounded to a multiple of it, at least one.
  VelocityCorrelation(double interval, double window, int n_levels = 16);

  /// At `time` [s]: unwrapped centres (n_rods) [mm], and the angle of the nematic director [rad]; n_rods is the same in
  /// every call.
  void accumulate(double time, std::span<const Vec3> unwrapped, double director);
  /// Averages over the origins t0 from `t_steady` [s] on.
  VelocityCurve reduce(double t_steady = -std::numeric_limits<double>::max()) const;
  VelocitySummary summarize(double t_steady = -std::numeric_limits<double>::max()) const;

  static auto fields(auto& self) {
    return listed(Setting{"window", self.steps_}, Length{self.places_}, self.places_, self.average_);
  }
  bool is_sound() const { return places_.size() <= steps_; }

 private:
  struct Places {
    double time = 0;
    LagFrame<2> frame;  // x, y unwrapped [mm]
    static auto fields(auto& self) { return listed(self.time, self.frame); }
  };

  std::size_t steps_;           // of a window
  std::vector<Places> places_;  // the last up to steps_ samples, oldest first
  LagAverage<VelocityKernel> average_;
};

}  // namespace shaken::analysis
