// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "analysis/estimate.h"
#include "run/measure/reduction.h"

namespace shaken::run {

inline Scalar scalar(const analysis::Estimate& estimate) { return {estimate.value, estimate.sem}; }

/// Two arrays, `path``unit` and `path`_sem`unit`.
inline void put(Reduction& result, const std::string& path, const std::string& unit,
                const analysis::EstimateCurve& curve) {
  result.arrays[path + unit] = curve.value;
  result.arrays[path + "_sem" + unit] = curve.sem;
}

}  // namespace shaken::run
