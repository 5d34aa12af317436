#pragma once

#include <random>

#include "base/core/types.h"

namespace shaken::test {

/// Random input for property tests; the seed is fixed in each test so that a failure can be repeated.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double normal() { return std::normal_distribution<double>()(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Vec3 vector(double scale) { return scale * Vec3{normal(), normal(), normal()}; }  // braces: in this order
  Vec3 direction() { return vector(1).normalized(); }
  /// A direction in the plane, tilted out of it by up to `n_z`.
  Vec3 flat_direction(double n_z) {
    const double angle = uniform(0, 2 * kPi);
    const double tilt = uniform(-n_z, n_z);
    const double level = std::sqrt(1 - tilt * tilt);
    return {level * std::cos(angle), level * std::sin(angle), tilt};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace shaken::test
