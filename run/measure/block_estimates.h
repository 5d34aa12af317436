// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "analysis/blocked.h"
#include "analysis/jackknife.h"
#include "run/measure/reduction.h"

namespace shaken::run {

/// The numbers that `numbers`(accumulator) gives of the samples from t_steady [s] on, with errors by the jackknife over
/// at most 16 blocks of time.
template <class Accumulator, class Numbers>
std::vector<Scalar> block_estimates(const analysis::Blocked<Accumulator>& samples, double t_steady, Numbers numbers) {
  std::vector<Scalar> scalars;
  for (const analysis::Estimate& estimate :
       analysis::jackknife(samples.empty(), samples.parts_after(t_steady, 16), numbers)) {
    scalars.push_back({estimate.value, estimate.sem});
  }
  return scalars;
}

}  // namespace shaken::run
