// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "bench/accuracy/observables.h"

namespace shaken::bench {

/// The straight line value + slope * x through measured means, by weighted least squares.
struct Limit {
  Mean at_zero;            ///< the limit x -> 0
  Mean slope;              ///< per unit of x
  double chi_squared = 0;  ///< sum of squared residuals over their errors; about `freedom` if the line holds
  int freedom = 0;
};

/// `x` and `means` of one length, at least two different x; every sem > 0.
Limit limit_of(std::span<const double> x, std::span<const Mean> means);

/// (of - truth) / truth; the error is of both, taken as independent.
Mean relative_bias(const Mean& of, const Mean& truth);

enum class Verdict { kBelow, kAbove, kOpen };
/// Whether the bias is below `bound` in size, with two standard errors to spare; kOpen where they do not tell.
Verdict judge(const Mean& bias, double bound);

/// Index of the last of `biases` (at rising steps) that, with all before it, is kBelow; none if the first is not.
std::optional<std::size_t> last_below(std::span<const Mean> biases, double bound);

}  // namespace shaken::bench
