#pragma once

#include "base/core/types.h"
#include "sim/motion/flight.h"
#include "sim/rod/species.h"
#include "sim/system.h"

namespace shaken {

/// How readily a rod gives way to an impulse.
struct InverseInertia {
  double mass;  ///< 1 / m [1/mg]
  double perp;  ///< 1 / I_perp [1/(mg mm^2)]
  double par;   ///< 1 / I_par [1/(mg mm^2)]
};
InverseInertia inverse_inertia(const Species& species);

/// Velocity of the material point at `arm` from the centre [mm/s].
inline Vec3 point_velocity(const Motion& motion, const Vec3& arm) {
  return motion.velocity + motion.angular_velocity.cross(arm);
}

/// Compliance K of a rod at the point `arm`: an impulse P there changes the point's velocity by K P.
/// K = (1/m + arm^2 / I_perp) 1 - arm arm^T / I_perp + (1/I_par - 1/I_perp) (n x arm)(n x arm)^T   [1/mg]
inline Mat3 point_compliance(const InverseInertia& inverse, const Vec3& director, const Vec3& arm) {
  const Vec3 lever = director.cross(arm);
  Mat3 K = (inverse.par - inverse.perp) * (lever * lever.transpose()) - inverse.perp * (arm * arm.transpose());
  K.diagonal().array() += inverse.mass + inverse.perp * arm.squaredNorm();
  return K;
}

/// Applies impulse P [mg mm/s] at `arm` to a rod.
inline void apply_impulse(Motion& motion, const InverseInertia& inverse, const Vec3& director, const Vec3& arm,
                          const Vec3& impulse) {
  const Vec3 torque = arm.cross(impulse);
  motion.velocity += inverse.mass * impulse;
  motion.angular_velocity += inverse.perp * torque + ((inverse.par - inverse.perp) * torque.dot(director)) * director;
}

/// The same along the normal of a bead at `offset` on the rod, whose normal passes through the rod's axis:
/// n . K n = 1/m + |offset director x normal|^2 / I_perp [1/mg].
inline double normal_compliance(const InverseInertia& inverse, const Vec3& director, double offset,
                                const Vec3& normal) {
  const double along = director.dot(normal);
  return inverse.mass + inverse.perp * (offset * offset * (1.0 - along * along));
}

/// Applies an impulse along the normal of the bead at `offset`. It passes through the axis, so the spin stays as it is.
inline void apply_normal_impulse(Motion& motion, const InverseInertia& inverse, const Vec3& director, double offset,
                                 const Vec3& impulse) {
  motion.velocity += inverse.mass * impulse;
  motion.angular_velocity += (inverse.perp * offset) * director.cross(impulse);
}

/// Impulse on the body that `normal` points to, by Newton's restitution and Coulomb's friction.
/// Model:  u = velocity of that body relative to the other at the contact, u_n = u . normal < 0 (approaching). Stick if
///         the impulse that gives u_n' = -e u_n and u_t' = 0 lies in the friction cone |P_t| <= mu P_n; otherwise slip:
///         P = p (normal - mu t) with t = u_t / |u_t| and p such that u_n' = -e u_n.
/// Source: Walton (1993) and Kane & Levinson (1985) for one impact with stick or slip; Sharma & Soni (2024), section 2.
/// Units:  K [1/mg], u [mm/s], result [mg mm/s]. K is symmetric and positive definite.
/// Numerics: never pulls. With friction so strong that the slip direction would jam (possible only beyond mu of about
///         1/taper), the tangential part of the sticking impulse, cut to the cone, takes the place of -t.
Vec3 newton_coulomb_impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact);

}  // namespace shaken
