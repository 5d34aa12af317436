#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "analysis/errors/estimate_curve.h"

namespace shaken::analysis {

/// g = 1 + 2 tau, the number of samples worth one independent one, in [1, n]. tau is the integrated autocorrelation
/// time in samples, the sum of rho(t) for t = 1 .. M, the window M being the first with M >= 5 (1 + 2 tau(M)) (Sokal
/// 1997, with the constant of emcee). 1 for a constant series or fewer than four samples. Costs at most a bounded
/// number of operations times log(n): where the window is long the series is first averaged in pairs, which leaves the
/// error of the mean as it is. Only as good as the series is long: trust it where n > 100 tau.
double statistical_inefficiency(std::span<const double> values);

/// Index at which the steady state begins: the first t0 that leaves nearly the most effective samples, nine tenths of
/// the largest N_eff = (n - t0) / g(t0) (Chodera, J. Chem. Theory Comput. 12, 1799 (2016)), g being that of parts
/// (variance_of_mean), which scatters less than a sum over lags. Long series are averaged to at most 512 points first;
/// t0 is looked for within the first three quarters, and not before the series has come back from its start to the mean
/// of its later half for the first time: an ordered start is no sample of a state that is less ordered, however few
/// effective samples it costs to keep it. Where the rest still drifts there is no steady state, and the last quarter is
/// what comes nearest to it.
std::size_t steady_index(std::span<const double> values);

/// Independent parts, counted about a parabola, that a steady state asks for: more than a single number does
/// (kEnoughIndependent), since all averages of a run hang on it. Shaken rods can stay for ten correlation times in a
/// state that they leave later. A series worth 50 independent samples has as many in five of six cases.
inline constexpr double kEnoughForSteadyState = 20;

/// A series' steady state in numbers.
struct SteadySummary {
  double mean = 0;
  double std = 0;  ///< spread of single samples: the bars of Sharma & Soni 2024, not an error of the mean
  /// Standard error of the mean, std / sqrt(n_effective); NaN: unknown (see summarize_parts).
  double sem = std::numeric_limits<double>::quiet_NaN();
  double tau = 0;          ///< integrated autocorrelation time [unit of times]
  double t_steady = 0;     ///< time of the first sample that counts
  double n_effective = 0;  ///< independent samples; 0 if no sample counts
  /// Whether this is a steady state at all: it is long enough to tell, its halves do not differ (see summarize_parts),
  /// and where it was looked for it was found in the first half. Nothing where it is too short to tell.
  std::optional<bool> steady;
  Estimate drift;  ///< mean of its later half less that of its earlier one
};

/// Summary of `values` (n) at equally spaced, rising `times` (n), from `steady_start` on, or from the time that
/// steady_index finds. Works for any length, also none, and for constant values. The error is by the
/// autocorrelation time, which makes it too small where the series is worth less than some 200 samples; up to 500 by
/// parts (summarize_parts) where that is larger.
SteadySummary summarize_series(std::span<const double> times, std::span<const double> values,
                               std::optional<double> steady_start = std::nullopt);

}  // namespace shaken::analysis
