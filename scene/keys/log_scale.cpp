#include "scene/keys/log_scale.h"

#include <cmath>

#include "base/core/natural_log.h"

namespace shaken::scene {
namespace {

/// e^x; the same bits on every machine. Numerics: x = k ln 2 + r with |r| <= ln(2) / 2, and the series of e^r, of which
/// the first term left out is below 1e-17.
double exponential(double x) {
  constexpr double kLn2High = 0x1.62e42fefa38p-1;  // as in natural_log.h
  constexpr double kLn2Low = 0x1.ef35793c7673p-45;
  const double k = std::floor(x / kLn2High + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double series = 1.0;
  for (int term = 14; term >= 1; --term) series = 1.0 + r / term * series;
  return std::ldexp(series, static_cast<int>(k));
}

}  // namespace

double between_on_log_scale(double from, double to, double share) {
  return from * exponential(share * natural_log(to / from));
}

}  // namespace shaken::scene
