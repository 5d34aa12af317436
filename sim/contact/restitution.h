#pragma once

#include <span>

#include "sim/system.h"

namespace shaken {

/// Restitution that falls with the speed v > 0 at which two bodies approach along the normal.
/// Model:  e(v) = 1 - (1 - e)(v / v_0)^(1/5) for v <= v_0, e (v / v_0)^(-1/4) above; e is that at v_0. Below v_0 the
///         bodies are viscoelastic (Hertz' contact with damping), above it they yield.
/// Source: McNamara & Falcon (2005), Phys. Rev. E 71, 031302, who take it for spheres of steel in a shaker; its
///         branches are the leading terms of Ramirez et al. (1999), Phys. Rev. E 60, 4465, and of Johnson (1985),
///         Contact Mechanics, section 11.5.
/// Units:  v, v_0 [mm/s]. The result is in (0, 1].
double falling_restitution(double restitution, double speed, double reference_speed);

/// Restitution of a contact whose bodies approach at `speed` [mm/s]; 1 where they do not approach.
inline double restitution_at(const ContactParameters& contact, double speed) {
  if (!contact.has_restitution_speed()) return contact.restitution;
  return falling_restitution(contact.restitution, speed, contact.restitution_speed);
}

/// The same of several contacts: speeds [mm/s] go in, restitutions come out in their places.
void restitution_at(const ContactParameters& contact, std::span<double> speeds);

}  // namespace shaken
