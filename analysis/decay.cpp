// SPDX-License-Identifier: MIT
#include "analysis/decay.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shaken::analysis {

Estimate decay_time(std::span<const double> lags, const EstimateCurve& correlation) {
  constexpr double kTarget = 1.0 / std::numbers::e;
  double t0 = 0, c0 = 1, sem0 = 0;
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double t1 = lags[i], c1 = correlation.value[i], sem1 = correlation.sem[i];
    if (c1 <= kTarget) {
      const double share = c1 > 0 ? (std::log(c0) + 1.0) / std::log(c0 / c1) : (c0 - kTarget) / (c0 - c1);
      const double slope = c1 > 0 ? kTarget * std::log(c0 / c1) / (t1 - t0) : (c0 - c1) / (t1 - t0);
      return {t0 + share * (t1 - t0), std::max(sem0, sem1) / slope};
    }
    t0 = t1;
    c0 = c1;
    sem0 = sem1;
  }
  return {};
}

}  // namespace shaken::analysis
