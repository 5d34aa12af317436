#pragma once

#include <cmath>
#include <vector>

#include "sim/contact/impulse.h"
#include "tests/support/random_rods.h"

namespace shaken::test {

/// An impact as an impulse law sees it.
struct ImpactInput {
  Mat3 K;
  Vec3 normal;
  Vec3 u;
};

/// Impacts of two rods, or of a rod and a plate: rods of several shapes in any pose, any bead, any approaching
/// velocity, among them many that hardly slip, where slip stops and reverses.
class RodImpacts {
 public:
  explicit RodImpacts(std::uint64_t seed) : draw_(seed) {
    for (const double length : {2.5, 3.5, 4.5}) {
      for (const int n_beads : {3, 9, 15}) rods_.push_back(make_species({.length = length, .n_beads = n_beads}));
    }
  }

  ImpactInput next() {
    ImpactInput impact;
    const Species& species = rods_[draw_.integer(0, static_cast<int>(rods_.size()) - 1)];
    const InverseInertia inverse = inverse_inertia(species);
    const bool plate = draw_.integer(0, 1) == 1;
    impact.normal = plate ? Vec3(0, 0, draw_.integer(0, 1) == 1 ? 1 : -1) : draw_.direction();
    impact.K.setZero();
    for (int r = 0; r < (plate ? 1 : 2); ++r) {
      const int bead = draw_.integer(0, species.n_beads() - 1);
      const Vec3 n = draw_.direction();
      const Vec3 arm = species.bead_offset[bead] * n + (r == 0 ? 1 : -1) * species.bead_radius[bead] * impact.normal;
      impact.K += point_compliance(inverse, n, arm);
    }
    approach(impact, 30);
    return impact;
  }

  /// The same for any symmetric positive definite K with a condition of up to 10^decades.
  ImpactInput next_of_any_compliance(double decades) {
    ImpactInput impact;
    const Vec3 a = draw_.direction();
    const Vec3 b = a.cross(draw_.direction()).normalized();
    const Vec3 c = a.cross(b);
    impact.K.setZero();
    for (const Vec3& axis : {a, b, c}) {
      impact.K += std::pow(10.0, 0.5 * decades * draw_.uniform(-1, 1)) * axis * axis.transpose();
    }
    impact.normal = draw_.direction();
    approach(impact, 1);
    return impact;
  }

 private:
  void approach(ImpactInput& impact, double speed) {
    Vec3 u = draw_.vector(speed);
    double u_n = u.dot(impact.normal);
    const Vec3 u_t = u - u_n * impact.normal;
    u_n = -std::abs(u_n);
    const double slip = draw_.integer(0, 2) == 0 ? std::pow(10.0, draw_.uniform(-4, 0)) : 1.0;
    impact.u = u_n * impact.normal + slip * u_t;
  }

  Draw draw_;
  std::vector<Species> rods_;
};

/// Change of kinetic energy by impulse P [pJ].
inline double energy_change(const ImpactInput& impact, const Vec3& P) {
  return impact.u.dot(P) + 0.5 * P.dot(impact.K * P);
}
/// The same as a fraction of the energies that are exchanged: what rounding is measured against.
inline double relative_energy_change(const ImpactInput& impact, const Vec3& P) {
  return energy_change(impact, P) / (impact.u.norm() * P.norm() + P.dot(impact.K * P));
}

}  // namespace shaken::test
