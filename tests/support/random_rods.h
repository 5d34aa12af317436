#pragma once

#include <random>

#include "base/core/types.h"
#include "sim/rod/species.h"

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

/// The same fore and aft, wider or narrower at the ends; polar; with free beads; a sphere.
inline Species random_species(Draw& draw) {
  switch (draw.integer(0, 3)) {
    case 0:
      return make_species({.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1});
    case 1:
      return make_species({.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}});
    case 2:
      return make_species({.length = draw.uniform(2.5, 4.5), .n_beads = 11, .profile = Profile::kPolar});
    default:
      return make_species({.length = draw.uniform(2.5, 4.5), .end_diameter = draw.uniform(0.2, 1.0), .n_beads = 9});
  }
}

}  // namespace shaken::test
