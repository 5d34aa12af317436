#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/parts.h"

namespace shaken::analysis {

/// What `function` makes of all samples, with errors by the delete-one jackknife over blocks of time (Miller,
/// Biometrika 61, 1 (1974)). What leaving out each of B blocks changes, times B - 1, is what that part of the run adds
/// to the estimate (Tukey's pseudo-values); estimate_from_parts takes error and steadiness from these. For a plain mean
/// they are the block means. Of any smooth function of sums, ratios and fits among them. Unknown with few blocks, where
/// fewer than kFewestParts of them have any part in the number (a bin that is seldom met), and where leaving out one
/// block leaves nothing to compute from.
/// @param blocks    parts of the run, disjoint and in order of time; accumulators with merge(const Accumulator&)
/// @param function  of an accumulator, giving a vector of numbers whose length does not depend on the samples
template <class Accumulator, class Function>
std::vector<Estimate> jackknife(const Accumulator& empty, const std::vector<Accumulator>& blocks, Function function) {
  std::vector<Accumulator> later(blocks.size() + 1, empty);  // [b]: from block b on
  for (std::size_t b = blocks.size(); b-- > 0;) {
    later[b] = blocks[b];
    later[b].merge(later[b + 1]);
  }
  const std::vector<double> values = function(later[0]);

  std::vector<std::vector<double>> parts(values.size());  // of each number
  Accumulator earlier = empty;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Accumulator others = earlier;
    others.merge(later[b + 1]);
    const std::vector<double> left_out = function(others);
    for (std::size_t k = 0; k < values.size(); ++k) {
      parts[k].push_back(values[k] + static_cast<double>(blocks.size() - 1) * (values[k] - left_out[k]));
    }
    earlier.merge(blocks[b]);
  }

  std::vector<Estimate> estimates;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto takes_part = [&](double part) { return !(std::abs(part - values[k]) <= 1e-11 * std::abs(values[k])); };
    const auto n = static_cast<std::size_t>(std::count_if(parts[k].begin(), parts[k].end(), takes_part));
    const bool is_seldom = n > 0 && n < kFewestParts;
    estimates.push_back(is_seldom ? Estimate{values[k]} : estimate_from_parts(values[k], parts[k]));
  }
  return estimates;
}

}  // namespace shaken::analysis
