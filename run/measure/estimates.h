#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/jackknife.h"
#include "run/files/unit_of_name.h"
#include "run/measure/reduction.h"

namespace shaken::run {

/// The estimate, and why it has no value if it has none.
inline Scalar scalar_or(const analysis::Estimate& estimate, const char* reason) {
  return {estimate, std::isnan(estimate.value) ? reason : ""};
}

/// An array, and that of its errors.
inline void put(Reduction& result, const std::string& path, const analysis::EstimateCurve& curve) {
  result.arrays[path] = curve.value;
  result.arrays[with_sem(path)] = curve.sem;
}

/// The numbers that `numbers`(accumulator) gives of the samples from t_steady [s] on, with errors by the jackknife over
/// all stretches of time that there are.
template <class Accumulator, class Numbers>
std::vector<Scalar> block_estimates(const analysis::Blocked<Accumulator>& samples, double t_steady, Numbers numbers) {
  std::vector<Scalar> scalars;
  for (const analysis::Estimate& estimate :
       analysis::jackknife(samples.empty(), samples.parts_after(t_steady, analysis::kMostParts), numbers)) {
    scalars.push_back({estimate});
  }
  return scalars;
}

/// Standard errors of curves, each found as block_estimates() finds those of numbers: `curves`(accumulator) gives
/// several curves whose lengths do not depend on the samples.
template <class Accumulator, class Curves>
std::vector<std::vector<double>> block_errors(const analysis::Blocked<Accumulator>& samples, double t_steady,
                                              Curves curves) {
  const auto joined = [&](const Accumulator& part) {
    std::vector<double> all;
    for (const std::vector<double>& curve : curves(part)) all.insert(all.end(), curve.begin(), curve.end());
    return all;
  };
  const std::vector<Scalar> points = block_estimates(samples, t_steady, joined);
  std::vector<std::vector<double>> errors;
  std::size_t k = 0;
  for (const std::vector<double>& curve : curves(samples.empty())) {
    std::vector<double>& sem = errors.emplace_back();
    for (std::size_t i = 0; i < curve.size(); ++i) sem.push_back(points[k++].sem);
  }
  return errors;
}

}  // namespace shaken::run
