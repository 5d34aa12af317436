#pragma once

#include <cstdint>
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

/// Turns of each rod in the plane between two samples.
struct TurnKernel {
  static constexpr std::string_view kName = "Rotation";
  static constexpr std::size_t kColumns = 1;     // unwrapped in-plane angle [rad], NaN for a rod that had none yet
  static constexpr std::size_t kQuantities = 2;  // turn^2 [rad^2], cos 2 turn
  static constexpr bool kLagZero = false;
  static LagPair<kQuantities> between(const LagFrame<kColumns>& origin, const LagFrame<kColumns>& later);
};

/// Rotation in the plane against lag; all of shape (lags met so far).
struct RotationCurve {
  std::vector<double> lag;  ///< [s], rising
  EstimateCurve msad;       ///< mean square angular displacement [rad^2]
  EstimateCurve c2;         ///< C_2(t) = <cos 2 (theta(t0 + t) - theta(t0))>
};

/// What rotation comes down to. One angle: MSAD = 2 D_r t.
struct RotationSummary {
  ShortAndLong growth;     ///< of the MSAD (see growth for the windows) [rad^2/s]
  Estimate d_r;            ///< at long lags, half the slope [rad^2/s]
  Estimate c2_plateau;     ///< mean of C_2 over LagCurve::last_octave; NaN where that is empty
  Estimate c2_decay_time;  ///< at which C_2 falls to 1/e (see decay_time) [s]; NaN if it does not
  double large_turns = 0;  ///< steps from sample to sample larger than pi/3, of all rods since the first sample
};

/// Rotation of the rods in the plane while the run goes on, at the lags of LagAverage and in 64 bytes per level and
/// rod. From sample to sample an angle is taken to change by less than a quarter turn: the step is folded into
/// [-pi/2, pi/2), which asks for an interval much shorter than 1 / D_r; large_turns says when it is too long. A rod
/// that tips over its end keeps its axis and has not turned. A rod exactly upright keeps the angle it had; one that
/// never had any is left out until it has. One that is NaN is missed in that sample, and goes on from the angle it had.
class Rotation : public Saved<Rotation> {
 public:
  /// `interval`: time between successive accumulate calls [s].
  explicit Rotation(double interval, int n_levels = 16) : average_(interval, n_levels) {}

  /// Directors (n_rods) at `time` [s]; n_rods is the same in every call.
  void accumulate(double time, std::span<const Vec3> directors);
  /// Averages over the origins from `t_steady` [s] on.
  RotationCurve reduce(double t_steady = -std::numeric_limits<double>::max()) const;
  RotationSummary summarize(double t_steady = -std::numeric_limits<double>::max()) const;

  static auto fields(auto& self) { return listed(self.large_turns_, self.average_); }

 private:
  LagAverage<TurnKernel> average_;
  std::int64_t large_turns_ = 0;
  std::vector<double> angles_;  // (n_rods) the last of each; not saved: no rod of a run is missed
};

}  // namespace shaken::analysis
