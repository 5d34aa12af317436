#include "bench/hard/same_mean.h"

#include <cmath>
#include <limits>

#include "base/estimate.h"

namespace shaken::bench {
namespace {

/// Half the width of an interval of 95 % confidence in units of the standard error; NaN with too few degrees of
/// freedom.
double student_at_95(double freedom) {
  constexpr double kNormal = 1.9599639845;
  return freedom >= 3 ? student_quantile(kNormal, freedom) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double Apart::farthest() const { return std::abs(difference) + half_width; }
double Apart::nearest() const { return std::abs(difference) - half_width; }

Sameness Apart::within(double bound) const {
  if (farthest() <= bound) return Sameness::kSame;
  return nearest() > bound ? Sameness::kDifferent : Sameness::kOpen;
}

Apart compare_means(std::span<const double> first, std::span<const double> second) {
  const Estimate a = mean_of_samples(first), b = mean_of_samples(second);
  const double size = std::abs(a.value + b.value) / 2;
  const double of_a = a.sem * a.sem, of_b = b.sem * b.sem, variance = of_a + of_b;
  const double freedom =
      variance * variance /
      (of_a * of_a / (static_cast<double>(first.size()) - 1) + of_b * of_b / (static_cast<double>(second.size()) - 1));
  return {(b.value - a.value) / size, student_at_95(freedom) * std::sqrt(variance) / size};
}

}  // namespace shaken::bench
