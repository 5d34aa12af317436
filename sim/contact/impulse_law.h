// SPDX-License-Identifier: MIT
#pragma once

#include "sim/contact/impact_process.h"
#include "sim/contact/impulse.h"

/// The impulse laws other than Newton's (impulse.h) as policies, for kernels that are composed with one of them.
namespace shaken {

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

}  // namespace shaken
