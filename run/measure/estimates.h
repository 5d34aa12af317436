// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "analysis/blocked.h"
#include "analysis/estimate.h"
#include "analysis/jackknife.h"
#include "run/measure/reduction.h"

namespace shaken::run {

inline Scalar scalar(const analysis::Estimate& estimate) { return {estimate.value, estimate.sem}; }

/// Two arrays, `path``unit` and `path`_sem`unit`.
inline void put(Reduction& result, const std::string& path, const std::string& unit,
                const analysis::EstimateCurve& curve) {
  result.arrays[path + unit] = curve.value;
  result.arrays[path + "_sem" + unit] = curve.sem;
}

inline void put(Reduction& result, const std::string& path, const std::string& unit,
                const std::vector<analysis::Estimate>& points) {
  analysis::EstimateCurve curve;
  for (const analysis::Estimate& point : points) curve.push_back(point);
  put(result, path, unit, curve);
}

/// The numbers that `numbers`(accumulator) gives of the samples from t_steady [s] on, with errors by the jackknife over
/// at most 16 blocks of time.
template <class Accumulator, class Numbers>
std::vector<Scalar> block_estimates(const analysis::Blocked<Accumulator>& samples, double t_steady, Numbers numbers) {
  std::vector<Scalar> scalars;
  for (const analysis::Estimate& estimate :
       analysis::jackknife(samples.empty(), samples.parts_after(t_steady, 16), numbers)) {
    scalars.push_back(scalar(estimate));
  }
  return scalars;
}

}  // namespace shaken::run
