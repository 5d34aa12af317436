// SPDX-License-Identifier: MIT
#include "client/replicas.h"

#include <algorithm>
#include <cmath>

namespace shaken::client {

double student_factor(std::size_t n) { return student_quantile(1, static_cast<double>(n) - 1); }

Estimate replica_mean(std::span<const double> values, std::span<const double> sems) {
  const std::size_t n = values.size();
  double variances = 0;
  std::size_t n_known = 0;
  for (const double sem : sems) {
    if (!std::isfinite(sem)) continue;
    variances += sem * sem;
    ++n_known;
  }
  const double within = std::sqrt(variances) / static_cast<double>(n);
  const bool all_known = n_known == n;
  Estimate result = mean_of_samples(values);
  if (n > 1) {
    result.sem = std::max(within, all_known ? result.sem : student_factor(n) * result.sem);
  } else if (all_known) {
    result.sem = within;
  }
  return result;
}

}  // namespace shaken::client
