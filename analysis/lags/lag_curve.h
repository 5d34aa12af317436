#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/estimate_curve.h"

namespace shaken::analysis {

/// `coefficient` times the mean of one quantity at one lag (index into LagCurve::lags): a part of a linear expression.
struct LagTerm {
  std::size_t quantity = 0;
  std::size_t lag = 0;
  double coefficient = 0;
};

/// Means of some quantities against lag, with what each stretch of origin time contributed to them.
class LagCurve {
 public:
  /// Sums over the pairs of samples whose origin lies in one stretch.
  struct Stretch {
    std::vector<double> rods;  ///< (lags) rods that counted, summed over the pairs
    std::vector<double> sums;  ///< (quantities * lags) over rods and pairs, quantity by quantity
  };

  LagCurve() = default;
  /// `lags` [s] rising; `independent` (lags): see below; stretches of the same length in order of time.
  LagCurve(std::vector<double> lags, std::vector<double> independent, std::size_t quantities,
           std::vector<Stretch> stretches);

  const std::vector<double>& lags() const { return lags_; }  ///< [s], rising
  /// (lags) how many times the lag fits into the time that the origins span: the independent looks at one rod.
  const std::vector<double>& independent() const { return independent_; }
  /// Mean over rods and origins.
  double mean(std::size_t quantity, std::size_t lag) const { return means_[quantity * lags_.size() + lag]; }

  /// A value with these terms, its standard error and the number of stretches behind it. The error is that of sum
  /// coefficient * mean, to first order also of any function with these derivatives, from the scatter between n
  /// stretches of origin time. Pairs whose ways overlap should lie in one stretch, so these are at least twice as
  /// long as the longest lag in `terms` where eight such fit, down to one lag to make eight, and at least five (NaN
  /// with fewer). What neighbours of c lags share all the same is corrected as for a random walk's mean square, by 1
  /// / (1 - 1 / 4c) in the square; the uncertain scatter of few stretches, by the variance of Student's t, (n - 1) /
  /// (n - 3). Right once a stretch is longer than the correlation time.
  Estimate estimate(double value, std::span<const LagTerm> terms) const;

  /// One linear combination of the quantities against lag; `weights` (quantities).
  EstimateCurve combination(std::span<const double> weights) const;

  /// The lags of one window, as indices [first, end); empty if first == end.
  struct Window {
    std::size_t first = 0;
    std::size_t end = 0;
    std::size_t size() const { return end - first; }
  };
  /// All lags in [from, to] [s].
  Window between(double from, double to) const;
  /// The last octave, [t/2, t], of lags up to the longest t with enough stretches for an error (see sem), about a sixth
  /// of the run; empty if it holds fewer than three lags.
  Window last_octave() const;

 private:
  /// The stretches joined to such as errors at one lag are taken from.
  struct Groups {
    std::size_t n = 0;
    std::vector<std::size_t> of_stretch;  ///< (stretches) in which of the n each one is
    double lags_each = 0;                 ///< their length in lags
  };
  Groups groups(std::size_t lag) const;

  std::vector<double> lags_, independent_;
  std::size_t quantities_ = 0;
  std::vector<Stretch> stretches_;
  std::vector<double> rods_;   // (lags)
  std::vector<double> means_;  // (quantities * lags)
};

}  // namespace shaken::analysis
