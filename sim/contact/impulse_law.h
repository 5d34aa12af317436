#pragma once

#include "base/core/check.h"
#include "sim/contact/impact_process.h"
#include "sim/contact/impulse.h"

namespace shaken {

/// Impulse on the body that `normal` points to, at a contact of compliance K whose bodies approach at u (impulse.h has
/// units and meanings).
using ImpulseFunction = Vec3 (*)(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact);

inline ImpulseFunction impulse_function(ImpulseLaw law) {
  switch (law) {
    case ImpulseLaw::kNewton:
      return &newton_coulomb_impulse;
    case ImpulseLaw::kPoisson:
      return &poisson_impulse;
    case ImpulseLaw::kEnergetic:
      return &energetic_impulse;
  }
  SHAKEN_CHECK(false, "unknown impulse law");
}

}  // namespace shaken
