#pragma once

#include <limits>
#include <span>

#include "analysis/errors/estimate_curve.h"
#include "analysis/lags/lag_curve.h"

namespace shaken::analysis {

/// How a mean square grows with the lag within one window of lags.
struct GrowthFit {
  double lag_from = std::numeric_limits<double>::quiet_NaN();  ///< shortest lag of the window [s]
  double lag_to = std::numeric_limits<double>::quiet_NaN();    ///< longest [s]
  /// The slope of the least-squares line with an intercept, [unit of the mean square / s]. In d dimensions D = slope /
  /// (2 d), also where a persistent or caged beginning has shifted the line.
  Estimate slope;
  Estimate exponent;  ///< slope of the least-squares line of logarithm on logarithm; 1 is normal diffusion
};

/// Growth at short and at long lags.
struct ShortAndLong {
  /// Two octaves from the end of the ballistic flight on, which is the shortest lag whose local exponent to the next
  /// lag is below 1.1; where that comes so late that they would reach into the long lags, the two octaves next before
  /// these: the exponent says that the motion still remembers. NaN where fewer than three lags are left.
  GrowthFit at_short;
  /// Over LagCurve::last_octave, the longest lags that have an error; NaN where that is empty.
  GrowthFit at_long;
};

/// The growth of the linear combination of a curve's quantities with `weights` (quantities), a mean square. Errors come
/// from the stretches of origin time (LagCurve::estimate). Windows of fewer than three lags give NaN, as do exponents
/// where the mean square is not positive.
ShortAndLong growth(const LagCurve& curve, std::span<const double> weights);

/// alpha(lag) = d ln MS / d ln lag from the neighbouring lags (at the ends from the last two); NaN at lag zero and
/// where MS is not positive.
EstimateCurve local_exponent(const LagCurve& curve, std::span<const double> weights);

/// Time at which a correlation that is 1 at lag 0 first falls to 1/e; NaN if it does not within the lags. Between two
/// lags its logarithm is taken as linear, exact for an exponential; the value itself where the later one is not
/// positive. The error is that of the correlation there over its slope. `lags` rising [s].
Estimate decay_time(std::span<const double> lags, const EstimateCurve& correlation);

}  // namespace shaken::analysis
