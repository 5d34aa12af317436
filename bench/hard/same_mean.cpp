// SPDX-License-Identifier: MIT
#include "bench/hard/same_mean.h"

#include <cmath>
#include <limits>

namespace shaken::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct ReplicaMean {
  double value = kNaN;
  double variance = kNaN;  ///< of the mean
  double freedom = 0;
};

ReplicaMean mean_of(std::span<const double> samples) {
  if (samples.size() < 2) return {};
  const auto n = static_cast<double>(samples.size());
  double sum = 0, squares = 0;
  for (const double sample : samples) sum += sample;
  for (const double sample : samples) squares += (sample - sum / n) * (sample - sum / n);
  return {sum / n, squares / (n - 1) / n, n - 1};
}

/// Beyond which Student's t lies once in forty times, to either side.
double student_at_95(double freedom) {
  if (!(freedom >= 3)) return kNaN;
  constexpr double z = 1.9599639845;
  const double z2 = z * z, f = freedom;
  return z * (1 + (z2 + 1) / (4 * f) + ((5 * z2 + 16) * z2 + 3) / (96 * f * f) +
              (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * f * f * f));
}

}  // namespace

double Apart::farthest() const { return std::abs(difference) + half_width; }
double Apart::nearest() const { return std::abs(difference) - half_width; }

Sameness Apart::within(double bound) const {
  if (farthest() <= bound) return Sameness::kSame;
  return nearest() > bound ? Sameness::kDifferent : Sameness::kOpen;
}

Apart compare(std::span<const double> first, std::span<const double> second) {
  const ReplicaMean a = mean_of(first), b = mean_of(second);
  const double size = std::abs(a.value + b.value) / 2;
  const double variance = a.variance + b.variance;
  const double freedom =
      variance * variance / (a.variance * a.variance / a.freedom + b.variance * b.variance / b.freedom);
  return {(b.value - a.value) / size, student_at_95(freedom) * std::sqrt(variance) / size};
}

}  // namespace shaken::bench
