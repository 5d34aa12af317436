#pragma once

#include <cstddef>
#include <vector>

#include "analysis/errors/estimate_curve.h"

namespace shaken::analysis {

/// The mean of what n summands add up to, or what was found over the number that was expected; NaN of none.
template <class Number>
double mean_of(double sum, Number n) {
  return n > 0 ? sum / static_cast<double>(n) : kNaN;
}

/// The middles of n bins of a width, the first of which begins at `from`.
inline std::vector<double> middles_of_bins(std::size_t n, double width, double from = 0) {
  std::vector<double> middles(n);
  for (std::size_t bin = 0; bin < n; ++bin) middles[bin] = from + (static_cast<double>(bin) + 0.5) * width;
  return middles;
}

}  // namespace shaken::analysis
