// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "analysis/estimate.h"

namespace shaken::analysis {

/// What `function` makes of all samples, with errors by the delete-one jackknife over blocks of time (Miller,
/// Biometrika 61, 1 (1974)): sem^2 = (B - 1) / B sum_b (f_b - mean f)^2, f_b being the function of all blocks but b. Of
/// any smooth function of sums, ratios and fits among them; for a plain mean it is the scatter of the block means. Only
/// as good as blocks are long against the correlation time. Unknown with fewer than two blocks, and where leaving out
/// one block leaves nothing to compute from.
/// @param blocks    parts of the run, disjoint; accumulators with merge(const Accumulator&)
/// @param function  of an accumulator, giving a vector of numbers whose length does not depend on the samples
template <class Accumulator, class Function>
std::vector<Estimate> jackknife(const Accumulator& empty, const std::vector<Accumulator>& blocks, Function function) {
  Accumulator all = empty;
  for (const Accumulator& block : blocks) all.merge(block);
  const std::vector<double> values = function(all);
  std::vector<Estimate> estimates(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) estimates[k].value = values[k];
  if (blocks.size() < 2) return estimates;

  std::vector<std::vector<double>> left_out;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Accumulator others = empty;
    for (std::size_t c = 0; c < blocks.size(); ++c) {
      if (c != b) others.merge(blocks[c]);
    }
    left_out.push_back(function(others));
  }
  const auto n = static_cast<double>(blocks.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    double sum = 0, squares = 0;
    for (const std::vector<double>& f : left_out) sum += f[k];
    for (const std::vector<double>& f : left_out) squares += (f[k] - sum / n) * (f[k] - sum / n);
    const double sem = std::sqrt((n - 1) / n * squares);
    if (std::isfinite(sem)) estimates[k].sem = sem;
  }
  return estimates;
}

}  // namespace shaken::analysis
