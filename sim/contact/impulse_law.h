// SPDX-License-Identifier: MIT
#pragma once

#include "sim/contact/impact_process.h"
#include "sim/contact/impulse.h"

/// The impulse laws as policies, for kernels that choose one when they are built, and a switch for those that do not.
namespace shaken {

struct NewtonLaw {
  static Vec3 impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact) {
    return newton_coulomb_impulse(K, normal, u, contact);
  }
};

struct PoissonLaw {
  static Vec3 impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact) {
    return poisson_impulse(K, normal, u, contact);
  }
};

struct EnergeticLaw {
  static Vec3 impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact) {
    return energetic_impulse(K, normal, u, contact);
  }
};

inline Vec3 impulse_by(ImpulseLaw law, const Mat3& K, const Vec3& normal, const Vec3& u,
                       const ContactParameters& contact) {
  switch (law) {
    case ImpulseLaw::kPoisson:
      return PoissonLaw::impulse(K, normal, u, contact);
    case ImpulseLaw::kEnergetic:
      return EnergeticLaw::impulse(K, normal, u, contact);
    case ImpulseLaw::kNewton:
      break;
  }
  return NewtonLaw::impulse(K, normal, u, contact);
}

}  // namespace shaken
