// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "base/estimate.h"

namespace shaken::client {

/// Mean over replicas of one point: `values` (n >= 1) of single runs, `sems` (n) their own standard errors, NaN where
/// unknown. Every run counts the same. Its standard error:
/// - where all own errors are known, the larger one of what they give, sqrt(sum sem^2) / n, and of the scatter between
///   the runs: two runs that happen to agree are no better than their own errors (the scale factor, never below 1, of
///   Particle Data Group, Review of Particle Physics (2022), section 5.2.2);
/// - otherwise the scatter between the runs, widened by Student's t so that it covers 68 % for few runs too, but never
///   less than the known errors give;
/// - of a single run its own.
Estimate replica_mean(std::span<const double> values, std::span<const double> sems);

/// The factor on the standard error of a mean of n >= 2 values by which +-1 of it holds 68.3 %, as for very many:
/// student_quantile with n - 1 degrees of freedom (1.3 % low for n = 2, else within 0.1 %).
double student_factor(std::size_t n);

}  // namespace shaken::client
