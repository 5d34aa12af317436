#pragma once

#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/saved.h"
#include "analysis/lags/lag_average.h"
#include "analysis/lags/lag_fits.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// In-plane displacements of each rod between two samples, squared; of those that have places in both.
struct DisplacementKernel {
  static constexpr std::string_view kName = "MeanSquareDisplacement";
  static constexpr std::size_t kColumns = 2;  // x, y unwrapped [mm]
  /// Along and across the director at the origin time, of the rods and of their centre of mass [mm^2].
  static constexpr std::size_t kQuantities = 4;
  static constexpr bool kLagZero = false;
  static LagPair<kQuantities> between(const LagFrame<kColumns>& origin, const LagFrame<kColumns>& later);
};

/// In-plane mean square displacements [mm^2]; all of shape (lags met so far).
struct MsdCurve {
  std::vector<double> lag;  ///< [s], rising
  EstimateCurve total;      ///< = along + across
  EstimateCurve along;      ///< along the nematic director at the origin time
  EstimateCurve across;     ///< across it
  /// The same of displacements less the mean displacement of all N rods, times N / (N - 1): without the drift of the
  /// whole, and of independent rods that do not drift the same as above. NaN of one rod.
  EstimateCurve relative_total, relative_along, relative_across;
  EstimateCurve exponent;  ///< d ln total / d ln lag (see local_exponent)
  /// MSD / (2 d t) of the above, d = 2 for the total and 1 along an axis [mm^2/s]: level where motion is diffusive. It
  /// nears D more slowly than the slope does.
  EstimateCurve d_total, d_along, d_across;
};

/// What the mean square displacements come down to (see growth for the windows). MSD = 4 D t in the plane and 2 D t
/// along one axis: D is a quarter of the slope of `total`, half the slope of `along` and `across`.
struct Diffusion {
  ShortAndLong total, along, across, relative;  ///< growth of the MSD [mm^2/s]; `relative` of relative_total
  Estimate d_short, d_long;                     ///< in the plane [mm^2/s]
  Estimate d_along, d_across;                   ///< at long lags [mm^2/s]
  Estimate d_relative;                          ///< in the plane at long lags, without the drift of the whole [mm^2/s]
};

/// Mean square displacement against lag, while the run goes on, at the lags of LagAverage and in its memory (128 bytes
/// per level and rod). "Along" and "across" refer to the nematic director of all rods at the origin time, not to the
/// single rod. A rod whose position is NaN is missed in that sample, and no rods give no lags.
class MeanSquareDisplacement : public Saved<MeanSquareDisplacement> {
 public:
  /// `interval`: time between successive accumulate calls [s].
  MeanSquareDisplacement(double interval, std::size_t n_rods, int n_levels = 16)
      : n_rods_(n_rods), average_(interval, n_levels) {}

  /// At `time` [s]: unwrapped centres (n_rods) [mm], and the angle of the nematic director [rad].
  void accumulate(double time, std::span<const Vec3> unwrapped, double director);
  /// Averages over the origins from `t_steady` [s] on.
  MsdCurve reduce(double t_steady = -std::numeric_limits<double>::max()) const;
  Diffusion diffusion(double t_steady = -std::numeric_limits<double>::max()) const;

  static auto fields(auto& self) { return listed(self.average_); }

 private:
  std::size_t n_rods_;
  LagAverage<DisplacementKernel> average_;
};

}  // namespace shaken::analysis
