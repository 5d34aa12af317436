#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Random numbers that are the same on every machine (the distributions of the standard library are not).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  double normal() { return std::sqrt(-2.0 * std::log(1.0 - uniform(0, 1))) * std::cos(uniform(0, 2 * kPi)); }

 private:
  std::mt19937_64 engine_;
};

/// A unit vector with in-plane angle `theta` and vertical component `n_z`.
inline Vec3 axis(double theta, double n_z = 0.0) {
  const double n_xy = std::sqrt(1.0 - n_z * n_z);
  return {n_xy * std::cos(theta), n_xy * std::sin(theta), n_z};
}

inline std::vector<Vec3> random_axes(Draw& draw, std::size_t n) {
  std::vector<Vec3> axes;
  for (std::size_t i = 0; i < n; ++i) axes.push_back(axis(draw.uniform(-kPi, kPi), draw.uniform(-0.3, 0.3)));
  return axes;
}

inline std::vector<Vec3> random_places(Draw& draw, std::size_t n, const Box& box) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < n; ++i) places.push_back({draw.uniform(0, box.x()), draw.uniform(0, box.y()), 0.5});
  return places;
}

/// x' = a x + noise with variance 1: integrated autocorrelation time a / (1 - a), statistical inefficiency
/// (1 + a) / (1 - a).
inline std::vector<double> ar1(Draw& draw, double a, std::size_t n) {
  std::vector<double> x{draw.normal()};
  while (x.size() < n) x.push_back(a * x.back() + std::sqrt(1 - a * a) * draw.normal());
  return x;
}

}  // namespace shaken::analysis
