#pragma once

#include "sim/contact/cofactors.h"
#include "sim/contact/impulse.h"
#include "sim/contact/restitution.h"
#include "sim/lanes/double_lanes.h"

/// Impulses at several contacts at a time: each lane has the bits of the functions of contact/impulse.h and
/// restitution.h.
namespace shaken::lanes {

/// As point_compliance makes it. Entries beside the diagonal differ from their mirror images by roundings.
template <class D>
struct ComplianceOf {
  D xx, xy, xz, yx, yy, yz, zx, zy, zz;

  SHAKEN_INLINE Triple<D> operator*(const Triple<D>& v) const {
    return {xx * v.x + (xy * v.y + xz * v.z), yx * v.x + (yy * v.y + yz * v.z), zx * v.x + (zy * v.y + zz * v.z)};
  }
};

template <class D>
SHAKEN_INLINE ComplianceOf<D> point_compliance(const InverseInertia& inverse, const Triple<D>& director,
                                               const Triple<D>& arm) {
  const Triple<D> lever = director.cross(arm);
  const double more = inverse.par - inverse.perp;
  const Triple<D> l{more * lever.x, more * lever.y, more * lever.z};
  const Triple<D> a{inverse.perp * arm.x, inverse.perp * arm.y, inverse.perp * arm.z};
  const D round = inverse.mass + inverse.perp * arm.squared_norm();
  return {(l.x * lever.x - a.x * arm.x) + round, l.x * lever.y - a.x * arm.y,
          l.x * lever.z - a.x * arm.z,           l.y * lever.x - a.y * arm.x,
          (l.y * lever.y - a.y * arm.y) + round, l.y * lever.z - a.y * arm.z,
          l.z * lever.x - a.z * arm.x,           l.z * lever.y - a.z * arm.y,
          (l.z * lever.z - a.z * arm.z) + round};
}

template <class D>
SHAKEN_INLINE D restitution_at(const ContactParameters& contact, const D& speed) {
  if (!contact.has_restitution_speed()) return D{} + contact.restitution;
  constexpr int W = sizeof(D) / sizeof(double);
  double e[W];
  store(e, speed);
  shaken::restitution_at(contact, std::span<double>(e));
  return load<W>(e);
}

template <class D>
struct ImpulseOf {
  Triple<D> P;
  D unknown;  ///< >= 0: what is to be done in this lane is not known here
};

/// With friction, by a restitution that is one number or one of each contact. Not known: slip without a direction, or
/// one that jams.
template <class D, class E>
SHAKEN_INLINE ImpulseOf<D> newton_coulomb_impulse(const ComplianceOf<D>& K, const Triple<D>& normal, const Triple<D>& u,
                                                  double mu, const E& restitution) {
  const D u_n = u.dot(normal);
  const D bounce = -(1.0 + restitution) * u_n;
  const Triple<D> u_t = u - u_n * normal;
  const Triple<D> wanted = bounce * normal - u_t;
  const auto stick =
      Cofactors<D>(K.xx, K.yy, K.zz, K.xy, K.xz, K.yz).template solve<Triple<D>>(wanted.x, wanted.y, wanted.z);
  const D stick_n = stick.dot(normal);
  const Triple<D> stick_t = stick - stick_n * normal;
  const D stick_t2 = stick_t.squared_norm();
  const D speed_t = square_root(u_t.squared_norm());
  const Triple<D> cone = normal - (mu / speed_t) * u_t;
  const D gain = normal.dot(K * cone);
  const Triple<D> slip = (bounce / gain) * cone;
  const D in_cone = mu * mu * stick_n * stick_n - stick_t2;
  const D sticks = stick_n > 0.0 ? in_cone : -1.0 - stick_t2;  // >= 0: yes
  const auto if_sticks = [&](const D& then, const D& otherwise) __attribute__((always_inline)) {
    return sticks >= 0.0 ? then : otherwise;
  };
  const D slips_well = smaller(gain, D(speed_t - 1e-12 * absolute(u_n)));
  return {{if_sticks(stick.x, slip.x), if_sticks(stick.y, slip.y), if_sticks(stick.z, slip.z)},
          if_sticks(-1.0 - stick_t2, -slips_well)};
}

}  // namespace shaken::lanes
