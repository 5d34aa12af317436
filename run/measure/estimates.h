#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/jackknife.h"
#include "run/measure/reduction.h"

namespace shaken::run {

inline Scalar scalar(const Estimate& estimate) { return {estimate}; }

/// The same, and why it has no value if it has none.
inline Scalar scalar_or(const analysis::Estimate& estimate, const char* reason) {
  Scalar result = scalar(estimate);
  if (std::isnan(result.value)) result.reason = reason;
  return result;
}

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
/// all stretches of time that there are.
template <class Accumulator, class Numbers>
std::vector<Scalar> block_estimates(const analysis::Blocked<Accumulator>& samples, double t_steady, Numbers numbers) {
  std::vector<Scalar> scalars;
  for (const analysis::Estimate& estimate :
       analysis::jackknife(samples.empty(), samples.parts_after(t_steady, analysis::kMostParts), numbers)) {
    scalars.push_back(scalar(estimate));
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
