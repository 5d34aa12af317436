#pragma once

#include <cstdint>

#include "analysis/errors/saved.h"

namespace shaken::analysis {

/// Mean and variance of samples, of which moments would lose a small spread to rounding.
/// Source: Welford, Technometrics 4, 419 (1962); Chan, Golub & LeVeque, Am. Stat. 37, 242 (1983).
struct Spread {
  std::int64_t samples = 0;
  double mean = 0;
  double squared = 0;  ///< sum of (x - mean)^2

  void accumulate(double x) {
    ++samples;
    const double from_mean = x - mean;
    mean += from_mean / static_cast<double>(samples);
    squared += from_mean * (x - mean);
  }
  /// Adds the samples of `other`.
  void merge(const Spread& other) {
    if (other.samples == 0) return;
    const auto n = static_cast<double>(samples), m = static_cast<double>(other.samples);
    const double apart = other.mean - mean;
    mean += apart * m / (n + m);
    squared += other.squared + apart * apart * n * m / (n + m);
    samples += other.samples;
  }
  /// NaN without samples.
  double variance() const { return squared / static_cast<double>(samples); }

  static auto fields(auto& self) { return listed(self.samples, self.mean, self.squared); }
};

}  // namespace shaken::analysis
