// SPDX-License-Identifier: MIT
#include "sim/contact/impulse.h"

#include <cmath>

namespace shaken {
namespace {

/// Solves K x = b for a symmetric positive definite K by cofactors.
Vec3 solve_symmetric(const Mat3& K, const Vec3& b) {
  const double a = K(0, 0), d = K(1, 1), f = K(2, 2);
  const double p = K(0, 1), q = K(0, 2), r = K(1, 2);
  const double c00 = d * f - r * r;
  const double c01 = q * r - p * f;
  const double c02 = p * r - q * d;
  const double c11 = a * f - q * q;
  const double c12 = p * q - a * r;
  const double c22 = a * d - p * p;
  const double inverse_det = 1.0 / (a * c00 + p * c01 + q * c02);
  return inverse_det * Vec3(c00 * b.x() + c01 * b.y() + c02 * b.z(), c01 * b.x() + c11 * b.y() + c12 * b.z(),
                            c02 * b.x() + c12 * b.y() + c22 * b.z());
}

}  // namespace

InverseInertia inverse_inertia(const Species& species) {
  return {1.0 / species.mass, 1.0 / species.inertia_perp, 1.0 / species.inertia_par};
}

Vec3 newton_coulomb_impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact) {
  const double u_n = u.dot(normal);
  const double bounce = -(1.0 + contact.restitution) * u_n;  // change of normal velocity wanted, > 0
  const double mu = contact.friction;

  // a frictionless contact needs neither the sticking impulse nor a slip direction
  if (!contact.has_friction()) return (bounce / normal.dot(K * normal)) * normal;

  const Vec3 u_t = u - u_n * normal;
  Vec3 stick = solve_symmetric(K, bounce * normal - u_t);
  const double stick_n = stick.dot(normal);
  const Vec3 stick_t = stick - stick_n * normal;
  const double stick_t2 = stick_t.squaredNorm();
  if (stick_n > 0 && stick_t2 <= mu * mu * stick_n * stick_n) return stick;

  const double speed_t = u_t.norm();
  if (speed_t > 1e-12 * std::abs(u_n)) {
    const Vec3 cone = normal - (mu / speed_t) * u_t;
    const double gain = normal.dot(K * cone);
    if (gain > 0) return (bounce / gain) * cone;
  }
  const Vec3 cone = normal + (mu / std::sqrt(stick_t2)) * stick_t;
  const double gain = normal.dot(K * cone);
  if (gain > 0) return (bounce / gain) * cone;
  return (bounce / normal.dot(K * normal)) * normal;
}

}  // namespace shaken
