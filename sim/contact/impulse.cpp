#include "sim/contact/impulse.h"

#include <cmath>

#include "sim/contact/cofactors.h"
#include "sim/contact/restitution.h"

namespace shaken {
InverseInertia inverse_inertia(const Species& species) {
  return {1.0 / species.mass, 1.0 / species.inertia_perp, 1.0 / species.inertia_par};
}

Vec3 newton_coulomb_impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact) {
  const double u_n = u.dot(normal);
  const double bounce = -(1.0 + restitution_at(contact, -u_n)) * u_n;  // change of normal velocity wanted, > 0
  const double mu = contact.friction;

  // a frictionless contact needs neither the sticking impulse nor a slip direction
  if (!contact.has_friction()) return (bounce / normal.dot(K * normal)) * normal;

  const Vec3 u_t = u - u_n * normal;
  const Vec3 wanted = bounce * normal - u_t;
  const Cofactors<double> of_K(K(0, 0), K(1, 1), K(2, 2), K(0, 1), K(0, 2), K(1, 2));
  auto stick = of_K.solve<Vec3>(wanted.x(), wanted.y(), wanted.z());
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
