// Whether two means are the same.
#pragma once

#include <span>

namespace shaken::bench {

/// What is known of whether a mean is the same in two places.
enum class Sameness {
  kSame,       ///< all of the interval of confidence lies within the bound
  kDifferent,  ///< all of it lies beyond
  kOpen,       ///< neither: too few samples to tell
};

/// How far apart two means are, as fractions of the size of the mean of both.
struct Apart {
  double difference = 0;  ///< of the second less the first
  double half_width = 0;  ///< of its interval of 95 % confidence; NaN where there are too few samples for one

  /// The end of the interval that is farther from nought.
  double farthest() const;
  double nearest() const;
  /// Whether they are the same but for `bound`. That no difference was seen does not make two means the same: the
  /// interval must exclude one as large as the bound, so that too few samples leave the question open.
  Sameness within(double bound) const;
};

/// Compares independent samples, each of which is as good as any other. The interval is Welch's (Biometrika 34, 28
/// (1947)), with student_quantile, which needs three degrees of freedom at least.
Apart compare_means(std::span<const double> first, std::span<const double> second);

}  // namespace shaken::bench
