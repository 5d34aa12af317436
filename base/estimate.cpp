#include "base/estimate.h"

namespace shaken {

Estimate mean_of_samples(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  Estimate result{.value = 0};
  for (const double sample : samples) result.value += sample / n;
  if (samples.size() < 2) return result;
  double squares = 0;
  for (const double sample : samples) squares += (sample - result.value) * (sample - result.value);
  result.sem = std::sqrt(squares / (n - 1) / n);
  return result;
}

double student_quantile(double z, double freedom) {
  const double z2 = z * z, x = 1 / freedom;
  const double first = (z2 + 1) / 4;
  const double second = ((5 * z2 + 16) * z2 + 3) / 96;
  const double third = (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
  return z * (1 + x * (first + x * (second + x * third)));
}

}  // namespace shaken
