// SPDX-License-Identifier: MIT
#include "sim/rod/species.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/core/check.h"

namespace shaken {
namespace {

/// Integrals over the profile R(x) of the beads' union.
struct ProfileIntegrals {
  double r1 = 0;    ///< of R
  double r2 = 0;    ///< of R^2
  double r4 = 0;    ///< of R^4
  double r2x2 = 0;  ///< of R^2 x^2
};

/// Integral of sqrt(r^2 - u^2) from 0 to u.
double half_disc(double r, double u) {
  const double c = std::clamp(u / r, -1.0, 1.0);
  return 0.5 * r * r * (c * std::sqrt(1.0 - c * c) + std::asin(c));
}

ProfileIntegrals integrate_profile(const std::vector<double>& offset, const std::vector<double>& radius) {
  const std::size_t n = offset.size();
  // between two neighbouring cuts one and the same bead is the outermost
  std::vector<double> cuts;
  for (std::size_t a = 0; a < n; ++a) {
    cuts.push_back(offset[a] - radius[a]);
    cuts.push_back(offset[a] + radius[a]);
    for (std::size_t b = a + 1; b < n; ++b) {
      const double ds = offset[b] - offset[a];
      if (ds > 0) {
        cuts.push_back(0.5 * (offset[a] + offset[b]) + (radius[a] * radius[a] - radius[b] * radius[b]) / (2 * ds));
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());

  ProfileIntegrals sum;
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const double from = cuts[c];
    const double to = cuts[c + 1];
    const double middle = 0.5 * (from + to);
    std::size_t outer = n;
    double outer_r2 = 0;
    for (std::size_t b = 0; b < n; ++b) {
      const double u = middle - offset[b];
      const double r2 = radius[b] * radius[b] - u * u;
      if (r2 > outer_r2) {
        outer = b;
        outer_r2 = r2;
      }
    }
    if (outer == n) continue;  // between beads that do not overlap
    const double s = offset[outer];
    const double r = radius[outer];
    sum.r1 += half_disc(r, to - s) - half_disc(r, from - s);
    // three Gauss-Legendre points are exact for polynomials up to degree 5
    constexpr std::array<double, 3> kNode{-0.7745966692414834, 0.0, 0.7745966692414834};
    constexpr std::array<double, 3> kWeight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
    for (int k = 0; k < 3; ++k) {
      const double x = middle + 0.5 * (to - from) * kNode[k];
      const double w = 0.5 * (to - from) * kWeight[k];
      const double r2 = r * r - (x - s) * (x - s);
      sum.r2 += w * r2;
      sum.r4 += w * r2 * r2;
      sum.r2x2 += w * r2 * x * x;
    }
  }
  return sum;
}

}  // namespace

Species make_species(const RodShape& shape) {
  SHAKEN_CHECK(shape.n_beads >= 1 && shape.n_beads % 2 == 1, "a rod has an odd number of beads");
  Species species;
  species.mid_radius = 0.5 * shape.mid_diameter;
  species.end_radius = shape.n_beads > 1 ? 0.5 * shape.end_diameter : species.mid_radius;
  species.max_radius = std::max(species.mid_radius, species.end_radius);
  species.half_length = shape.n_beads > 1 ? 0.5 * shape.length - species.end_radius : 0.0;
  const int middle = shape.n_beads / 2;
  for (int b = 0; b < shape.n_beads; ++b) {
    const double along = middle > 0 ? static_cast<double>(b - middle) / middle : 0.0;  // -1 .. 1, exactly antisymmetric
    species.bead_offset.push_back(species.half_length * along);
    species.bead_radius.push_back(species.mid_radius - (species.mid_radius - species.end_radius) * std::abs(along));
  }

  const ProfileIntegrals profile = integrate_profile(species.bead_offset, species.bead_radius);
  species.area = 2.0 * profile.r1;
  species.mass = shape.density * kPi * profile.r2;
  species.inertia_par = shape.density * 0.5 * kPi * profile.r4;
  species.inertia_perp = shape.density * kPi * (0.25 * profile.r4 + profile.r2x2);
  return species;
}

int beads_for_pitch(double length, double end_diameter, double pitch) {
  const double axis = length - end_diameter;
  // a pitch that fits up to rounding fits
  const int intervals = static_cast<int>(std::ceil(axis / pitch * (1.0 - 1e-12)));
  return intervals + 1 + intervals % 2;
}

}  // namespace shaken
