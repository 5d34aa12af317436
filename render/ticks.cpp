#include "render/ticks.h"

#include <fmt/format.h>

#include <cmath>

namespace shaken::render {

double tick_step(double span, int most, bool degrees) {
  const double least = span / most;
  if (degrees) {
    for (const double step : {15.0, 30.0, 45.0}) {
      if (step >= least) return step;
    }
    return 90;
  }
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> all;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double k = first; k <= last; ++k) all.push_back(k == 0 ? 0.0 : k * step);
  return all;
}

std::string tick_text(double value, std::string_view unit) {
  return fmt::format("{}{:.6g}{}", value < 0 ? "\u2212" : "", std::abs(value), unit);
}

}  // namespace shaken::render
