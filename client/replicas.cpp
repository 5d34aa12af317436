// SPDX-License-Identifier: MIT
#include "client/replicas.h"

#include <algorithm>
#include <cmath>

namespace shaken::client {

Estimate mean_and_error(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  Estimate result{.value = 0};
  for (const double value : values) result.value += value / n;
  if (values.size() < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.value) * (value - result.value);
  result.sem = std::sqrt(squares / (n - 1) / n);
  return result;
}

double student_factor(std::size_t n) {
  const double x = 1 / (static_cast<double>(n) - 1);
  return 1 + x * (0.5 + x * (0.25 + x * 0.0625));
}

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
  Estimate result = mean_and_error(values);
  if (n > 1) {
    result.sem = std::max(within, all_known ? result.sem : student_factor(n) * result.sem);
  } else if (all_known) {
    result.sem = within;
  }
  return result;
}

}  // namespace shaken::client
