// SPDX-License-Identifier: MIT
#include "bench/accuracy/bias.h"

#include <cmath>

namespace shaken::bench {

Limit limit_of(std::span<const double> x, std::span<const Mean> means) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double weight = 1 / (means[k].sem * means[k].sem);
    s += weight;
    sx += weight * x[k];
    sy += weight * means[k].value;
    sxx += weight * x[k] * x[k];
    sxy += weight * x[k] * means[k].value;
  }
  const double determinant = s * sxx - sx * sx;
  Limit limit;
  limit.at_zero = {(sxx * sy - sx * sxy) / determinant, std::sqrt(sxx / determinant)};
  limit.slope = {(s * sxy - sx * sy) / determinant, std::sqrt(s / determinant)};
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double off = (means[k].value - limit.at_zero.value - limit.slope.value * x[k]) / means[k].sem;
    limit.chi_squared += off * off;
  }
  limit.freedom = static_cast<int>(x.size()) - 2;
  return limit;
}

Mean relative_bias(const Mean& of, const Mean& truth) {
  const double ratio = of.value / truth.value;
  return {ratio - 1, std::hypot(of.sem / truth.value, ratio * truth.sem / truth.value)};
}

Verdict judge(const Mean& bias, double bound) {
  if (std::abs(bias.value) + 2 * bias.sem < bound) return Verdict::kBelow;
  if (std::abs(bias.value) - 2 * bias.sem > bound) return Verdict::kAbove;
  return Verdict::kOpen;
}

std::optional<std::size_t> last_below(std::span<const Mean> biases, double bound) {
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < biases.size() && judge(biases[k], bound) == Verdict::kBelow; ++k) last = k;
  return last;
}

}  // namespace shaken::bench
