#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "base/core/series_limits.h"

namespace shaken::analysis {

/// As many parts of time as errors are taken from, at most: those that sums are kept for.
inline constexpr std::size_t kMostParts = kMostStretches;
/// With fewer parts, or fewer independent ones among them, there is no error.
inline constexpr std::size_t kFewestParts = 10;
inline constexpr double kFewestIndependent = 5;
/// Whether something is steady cannot be told from fewer independent parts. They are counted about a parabola, which
/// makes them fewer: a series of 20 independent samples reaches this every other time.
inline constexpr double kEnoughIndependent = 12;
/// So many of its errors a difference of the halves is a drift: by chance in one of a hundred steady series.
inline constexpr double kDriftErrors = 2.6;

double mean_of(std::span<const double> values);

/// What the numbers of successive, equally long parts of a run say of their mean.
struct PartsSummary {
  double mean = 0;
  /// Standard error of the mean, spread * sqrt(g / n). NaN: too few parts or independent ones, or no spread.
  double sem = 0;
  double n_effective = 0;      ///< independent parts, n / g; NaN: too few parts, or no spread to tell of
  Estimate drift;              ///< mean of the later half less that of the earlier one
  std::optional<bool> steady;  ///< whether there is no such drift; none if that cannot be told
};

/// Parts are taken as an autoregressive series of first order, for which g = (1 + rho) / (1 - rho) (Bayley &
/// Hammersley, Suppl. J. R. Stat. Soc. 8, 184 (1946)), rho being the correlation of neighbours, less the bias of its
/// estimate, -(1 + 3 rho) / n (Kendall, Biometrika 41, 403 (1954)), and at least 0. Right for parts as long as the
/// correlation time and for such a tenth of it: of an Ornstein-Uhlenbeck series worth 12 samples the mean square of
/// (mean - truth) / sem is 0.9 to 1.2, for any number of parts from 16 to 64; of 10 uncorrelated parts it is 1.1.
///
/// Drift: the difference of the halves (as Geweke, Bayesian Statistics 4, 169 (1992), of the first tenth and the last
/// half) against its own error, which is taken about a parabola: or else a drift would count as the noise that hides
/// it. The bias of rho is then -(3 + 5 rho) / n. Steady is what has enough independent parts and no drift of more than
/// kDriftErrors errors; what does not vary at all is steady.
PartsSummary summarize_parts(std::span<const double> parts);

/// The square of that error, whatever the number of parts; 0 with fewer than two.
double variance_of_mean(std::span<const double> parts);

/// An estimate of `value` whose changes the parts show: each is what the estimate would be if all were like it, to
/// first order. Their mean does not matter.
Estimate estimate_from_parts(double value, std::span<const double> parts);

/// Means over kMostParts parts of a series, or over as many as it has values; as long as each other but for one value.
std::vector<double> parts_of_series(std::span<const double> values);

}  // namespace shaken::analysis
