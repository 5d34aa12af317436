#pragma once

#include <optional>

#include "sim/contact/restitution.h"
#include "sim/tick/tick.h"

/// One impact, of a bead on a surface (tick/surface_impacts.h) or on another bead (tick/rod_impacts.h).
///
/// Model:    An impulse P changes the velocity and the angular velocity of a rod at once. Where the contact has
///           friction, the scene's impulse law gives P (contact/impulse_law.h). Without friction P lies along the
///           normal, which passes through the rod's axis: neither a slip direction nor the spin about the axis enters.
/// Instant:  A tick finds an impact when the beads already overlap. By default they get their impulse there, at the end
///           of the tick, which is first order in the tick. With `time.impacts` = "at_instant" they are first flown
///           back to where they touched, overlap / approach speed ago, get their impulse, and fly on to the end of the
///           tick: second order.
/// Numerics: An overlap older than one tick belongs to beads that rest on each other. Those are dealt with at the end
///           of the tick in either case, since their straight way back would be longer than the tick.
namespace shaken::impact {

/// An impulse and what it did to the energy of the two bodies' relative motion.
struct Impulse {
  Vec3 P;       ///< on the body that the normal points to [mg mm/s]
  double lost;  ///< -P . (u + u') / 2 [pJ]
};

/// The bead of a rod that takes part.
struct Bead {
  const SpeciesMechanics& species;
  RodAtTick& rod;
  double offset;  ///< of its centre from the rod's, along the director [mm]
  Vec3 arm;       ///< from the rod's centre to the contact [mm]

  Vec3 velocity() const { return point_velocity(rod.motion, arm); }
  Mat3 compliance() const { return point_compliance(species.inverse, rod.pose.director, arm); }
  double compliance_along(const Vec3& normal) const {
    return normal_compliance(species.inverse, rod.pose.director, offset, normal);
  }
  /// Any impulse P.
  void apply(const Vec3& P) const {
    apply_impulse(rod.motion, species.inverse, rod.pose.director, arm, P);
    rod.changed = true;
  }
  /// One along the normal.
  void apply_along_normal(const Vec3& P) const {
    apply_normal_impulse(rod.motion, species.inverse, rod.pose.director, offset, P);
    rod.changed = true;
  }
};

/// -P . (u + K P / 2) [pJ], written out so that the compiler keeps it in registers.
inline double work_lost(const Vec3& P, const Vec3& u, const Mat3& K) {
  double lost = 0;
  for (Eigen::Index r = 0; r < 3; ++r) lost -= P[r] * (u[r] + 0.5 * (K(r, 0) * P[0] + K(r, 1) * P[1] + K(r, 2) * P[2]));
  return lost;
}

/// Without friction: u_n' = -e u_n.
inline Impulse frictionless(const Vec3& normal, const Vec3& u, double compliance, const ContactParameters& contact) {
  const double u_n = u.dot(normal);
  const double p = -(1.0 + restitution_at(contact, -u_n)) * u_n / compliance;
  return {p * normal, -p * (u_n + 0.5 * p * compliance)};
}

/// Flies the rod freely for `seconds`, of either sign, from or to the end of the tick.
inline void fly(RodAtTick& rod, double seconds, const SpeciesMechanics& species, const Gravity& gravity) {
  Flight flight;
  flight.position = rod.pose.position;
  flight.velocity = rod.motion.velocity;
  flight.director = rod.pose.director;
  flight.spin = rod.motion.angular_velocity.dot(flight.director);
  flight.precession = rod.motion.angular_velocity - (1.0 - species.inertia_ratio) * flight.spin * flight.director;
  flight.prepare();
  rod.pose = pose_after(flight, seconds, gravity);
  rod.motion = motion_after(flight, seconds, gravity, rod.pose.director, species.inertia_ratio);
}

/// How long ago an overlap began if the surfaces have approached at `speed` since [s]; none if not within this tick.
inline std::optional<double> time_since_touch(double overlap, double speed, double dt) {
  if (!(speed > 0) || overlap > speed * dt) return {};
  return overlap / speed;
}

}  // namespace shaken::impact
